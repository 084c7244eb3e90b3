/* A picture as it is shown: sRGB values from 0 to 1, with what becomes of its noise. */
#ifndef EC_IMAGE_SHOWN_H
#define EC_IMAGE_SHOWN_H

#include "film/measured.h"
#include "image/image.h"

typedef struct ec_look {
    ec_tonemap tonemap;
    double exposure; /* stops */
} ec_look;

/* Linear values to shown ones, 3 floats a pixel; in and out may be the same. */
void ec_show(const ec_look *look, const float *in, uint64_t pixel_count, float *out);

/* The standard errors of `linear` through the curve, in whose place they may be (linear->se and se_y), by three points of a normal distribution
 * along each channel alone and along all together, weighted so that se_y comes out; without se_y the channels' noise is taken for one.
 * slack, 3 a pixel: how far noise moves the mean of what is shown, as curves bend. To be called with rgb still linear. */
void ec_show_noise(const ec_look *look, const ec_measured *linear, float *se, float *se_y, float *slack);

/* How far noise of `se` in shown values moves their mean where the linear picture without it is `rgb`: added to slack. */
void ec_show_bend(const ec_look *look, const float *rgb, const float *se, uint64_t pixel_count, float *slack);

/* The exposure, in stops, at which the linear picture looks most like the shown one: least squares over the pixels that count. look: its curve. */
double ec_fit_exposure(const ec_look *look, const ec_measured *linear, const ec_measured *shown);

#endif
