/* A backdrop, seen where a picture has no surface: a blurred environment map at infinity, as a camera sees it. */
#ifndef EC_IMAGE_BEHIND_H
#define EC_IMAGE_BEHIND_H

#include <stdint.h>

typedef struct ec_behind {
    float *rgb;                   /* 3 floats per texel of an equirectangular map, rows from +y; owned. NULL: black */
    uint32_t width, height;       /* of the map */
    double turn[9];               /* rotation from the map's directions to the scene's, row major */
    double corner[3], across[3], down[3]; /* pixel (x, y) looks along corner + x across + y down, which need not be a unit vector */
} ec_behind;

/* Returns the radiance in the middle of pixel (x, y), interpolated bilinearly. */
void ec_behind_look(const ec_behind *behind, uint32_t x, uint32_t y, double rgb[3]);

#endif
