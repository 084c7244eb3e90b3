/* A picture as shown on a screen, sRGB values from 0 to 1, and what becomes of its noise. */
#ifndef EC_IMAGE_SHOWN_H
#define EC_IMAGE_SHOWN_H

#include "film/measured.h"
#include "image/image.h"

typedef struct ec_look {
    ec_tonemap tonemap;
    double exposure; /* stops */
} ec_look;

/* Converts linear values to shown ones, 3 floats per pixel; in and out may be the same. */
void ec_show(const ec_look *look, const float *in, uint64_t pixel_count, float *out);

/* Propagates the standard errors of `linear` through the curve; results may replace linear->se and se_y. Uses three points of a normal distribution
 * along each channel alone and along all together, weighted so that se_y comes out; without se_y, the channels' noise is taken as fully correlated.
 * slack, 3 per pixel: increased by how far noise shifts the mean, as curves bend. tail_se, 3 per pixel: a quarter of how far four standard errors of
 * all channels reach, on the larger side; at least se. To be called while rgb is still linear. */
void ec_show_noise(const ec_look *look, const ec_measured *linear, float *se, float *se_y, float *slack, float *tail_se);

/* Adds to slack how far noise of `se` in shown values shifts their mean, where `rgb` is the linear picture without noise. */
void ec_show_bend(const ec_look *look, const float *rgb, const float *se, uint64_t pixel_count, float *slack);

/* Returns the exposure, in stops, at which the linear picture looks most like the shown one: least squares over the pixels that count. look: gives
 * the curve. */
double ec_fit_exposure(const ec_look *look, const ec_measured *linear, const ec_measured *shown);

#endif
