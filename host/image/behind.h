/* What lies behind the surfaces of a picture: a blurred map of infinitely far away, as a camera sees it. */
#ifndef EC_IMAGE_BEHIND_H
#define EC_IMAGE_BEHIND_H

#include <stdint.h>

typedef struct ec_behind {
    float *rgb;                   /* 3 a texel of an equirectangular map, rows from +y; owned. NULL: black */
    uint32_t width, height;       /* of it */
    double turn[9];               /* row major: its directions to the scene's, a rotation */
    double corner[3], across[3], down[3]; /* pixel (x, y) looks along corner + x across + y down, which need not be a unit vector */
} ec_behind;

/* Radiance in the middle of pixel (x, y), bilinear. */
void ec_behind_look(const ec_behind *behind, uint32_t x, uint32_t y, double rgb[3]);

#endif
