/* What a picture for the screen is made of: exposure, tone curve, what lies behind surfaces. */
#ifndef EC_IMAGE_SCREEN_H
#define EC_IMAGE_SCREEN_H

#include <stdint.h>

#include "image/behind.h"
#include "image/ocio.h"
#include "image/tone_curve.h"

typedef enum ec_backdrop { EC_BACKDROP_ENVIRONMENT, EC_BACKDROP_TRANSPARENT, EC_BACKDROP_COLOR, EC_BACKDROP_BLUR } ec_backdrop;

typedef struct ec_background {
    ec_backdrop kind;
    uint8_t rgb[3]; /* of a colour: sRGB, as the screen has it */
    float degrees;  /* of a blur: its standard deviation */
} ec_background;

typedef struct ec_screen {
    float exposure; /* EV */
    ec_tonemap tonemap;
    ec_background background;
    const ec_behind *behind; /* of a blur */
    const ec_ocio *ocio;     /* in place of the tone curve and sRGB's; NULL: none */
} ec_screen;

/* A grid of pixels, rows from the top. */
typedef struct ec_raster {
    uint32_t width, height;
    uint32_t channels; /* 3, or 4 with an alpha that colours are not multiplied by */
    uint32_t bits;     /* of a channel: 8; 16, the high byte first; 32: floats, linear */
} ec_raster;

static inline uint32_t ec_raster_pixel_bytes(const ec_raster *r) { return r->channels * r->bits / 8; }

/* Linear Rec. 709 radiance, 3 floats a pixel, to 8 or 16 bits of sRGB: rgb * 2^exposure, tone curve, exact sRGB curve; non-finite values become 0.
 * alpha, every stride-th float: the part of each pixel that surfaces cover, whose light alone rgb then is; looked at where the background is not the
 * environment. A colour lies behind what the tone curve or a view has made, as sRGB, a blurred environment before it. first: number of the first pixel in the picture, row by row. */
void ec_screen_pixels(const ec_screen *screen, const float *rgb, const float *alpha, uint32_t stride, uint64_t first, uint64_t count, const ec_raster *to, void *out);

#endif
