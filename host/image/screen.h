/* How a picture for the screen is made: exposure, tone curve, background. */
#ifndef EC_IMAGE_SCREEN_H
#define EC_IMAGE_SCREEN_H

#include <stdint.h>

#include "image/behind.h"
#include "image/ocio.h"
#include "image/tone_curve.h"

typedef enum ec_backdrop { EC_BACKDROP_ENVIRONMENT, EC_BACKDROP_TRANSPARENT, EC_BACKDROP_COLOR, EC_BACKDROP_BLUR } ec_backdrop;

typedef struct ec_background {
    ec_backdrop kind;
    uint8_t rgb[3]; /* for a colour: sRGB, as the screen shows it */
    float degrees;  /* for a blur: its standard deviation */
} ec_background;

typedef struct ec_screen {
    float exposure; /* EV */
    ec_tonemap tonemap;
    ec_background background;
    const ec_behind *behind; /* for a blur */
    const ec_ocio *ocio;     /* replaces the tone curve and the sRGB curve; NULL: none */
} ec_screen;

/* A grid of pixels, with rows from the top. */
typedef struct ec_raster {
    uint32_t width, height;
    uint32_t channels; /* 3, or 4 with alpha, not premultiplied */
    uint32_t bits;     /* per channel: 8; 16, the high byte first; 32: linear floats */
} ec_raster;

static inline uint32_t ec_raster_pixel_bytes(const ec_raster *r) { return r->channels * r->bits / 8; }

/* Converts linear Rec. 709 radiance, 3 floats per pixel, to 8 or 16 bits of sRGB: rgb * 2^exposure, tone curve, exact sRGB curve; non-finite values
 * become 0. alpha, every stride-th float: the part of each pixel that surfaces cover; used if the background is not the environment, in which case
 * rgb is the light of surfaces alone. A background colour is added after the tone curve or view, so that it is shown as given, a blurred environment
 * before it. first: number of the first pixel in the picture, row by row. */
void ec_screen_pixels(const ec_screen *screen, const float *rgb, const float *alpha, uint32_t stride, uint64_t first, uint64_t count, const ec_raster *to, void *out);

#endif
