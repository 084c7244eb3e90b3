/* A picture on the six faces of a cube about the origin, laid out as OpenGL has it (4.6 core, table 8.19): faces +x, -x, +y, -y,
 * +z, -z, rows from the top. */
#ifndef EC_GLTF_CUBE_H
#define EC_GLTF_CUBE_H

#include <stdint.h>

#include "scene/scene.h"

typedef struct ec_cube {
    uint32_t size;  /* pixels a side */
    float *face[6]; /* 3 * size * size each, linear, owned */
} ec_cube;

void ec_cube_free(ec_cube *cube);

/* The cube as an equirectangular picture, oriented as ec_environment: width x height pixels, 3 floats each. A pixel is the mean of
 * samples x samples points of it, each interpolated bilinearly, also across the cube's edges. Any number of threads, the same bits. */
void ec_cube_unroll(const ec_cube *cube, uint32_t width, uint32_t height, uint32_t samples, float *rgb);

/* Makes an environment of the cube: a constant where all pixels are alike, else a map, owned by *e, as many pixels around as four faces
 * have (those are as dense as the cube's in the middle of a face), 4096 at most, turned by a unit quaternion (x, y, z, w). */
ec_result ec_cube_environment(const ec_cube *cube, const double rotation[4], ec_environment *e, ec_error *err);

#endif
