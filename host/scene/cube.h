/* A picture on the six faces of a cube about the origin, laid out as OpenGL has it (4.6 core, table 8.19): faces +x, -x, +y, -y,
 * +z, -z, rows from the top. Inside host/scene/ only. */
#ifndef EC_SCENE_CUBE_H
#define EC_SCENE_CUBE_H

#include <stdint.h>

#include "base/error.h"

typedef struct ec_cube {
    uint32_t size;  /* pixels a side */
    float *face[6]; /* 3 * size * size each, linear, owned */
} ec_cube;

void ec_cube_free(ec_cube *cube);

/* The same picture equirectangular, oriented as ec_environment: width x height pixels, 3 floats each. A pixel is the mean of
 * samples x samples points of it, each interpolated bilinearly, also across the cube's edges. Any number of threads, the same bits. */
void ec_cube_unroll(const ec_cube *cube, uint32_t width, uint32_t height, uint32_t samples, float *rgb);

#endif
