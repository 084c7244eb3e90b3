/* A picture on the six faces of a cube about the origin, laid out as OpenGL has it (4.6 core, table 8.19): faces +x, -x, +y, -y,
 * +z, -z, rows from the top. */
#ifndef EC_GLTF_CUBE_H
#define EC_GLTF_CUBE_H

#include <stdint.h>

#include "scene/scene.h"

typedef struct ec_cube {
    uint32_t size;  /* pixels per side */
    float *face[6]; /* 3 * size * size each, linear, owned */
} ec_cube;

void ec_cube_free(ec_cube *cube);

/* Resamples the cube to an equirectangular picture, oriented like ec_environment: width x height pixels of 3 floats. Each pixel is the mean of
 * samples x samples points, interpolated bilinearly, also across the cube's edges. The result does not depend on the number of threads. */
void ec_cube_unroll(const ec_cube *cube, uint32_t width, uint32_t height, uint32_t samples, float *rgb);

/* Makes an environment of the cube, turned by the unit quaternion (x, y, z, w): a constant if all pixels are equal, otherwise a map, owned by *e. The
 * map has as many pixels around as four faces have, 4096 at most; these are as dense as the cube's in the middle of a face. */
ec_result ec_cube_environment(const ec_cube *cube, const double rotation[4], ec_environment *e, ec_error *err);

#endif
