/* Environments that need no file: maps made by formula. */
#ifndef EC_SCENE_BUILT_IN_H
#define EC_SCENE_BUILT_IN_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

#define EC_STUDIO "studio"
#define EC_SKY "sky:"

/* Pixels as ec_environment has them; rgb is malloc'ed. */
typedef struct ec_made_map {
    uint32_t width, height;
    float *rgb;
} ec_made_map;

/* "studio" or "sky:AZIMUTH,ELEVATION"? Then no file of that name is meant. */
bool ec_is_built_in(const char *spec);
ec_result ec_built_in_make(const char *spec, ec_made_map *map, ec_error *err);

/* A unit direction of texel (x, y)'s middle. */
void ec_made_map_direction(const ec_made_map *map, uint32_t x, uint32_t y, double d[3]);
double ec_made_map_solid_angle(const ec_made_map *map, uint32_t y); /* of a texel in that row */

/* Grey walls and five soft boxes, for a subject that faces +z; the mean radiance over all directions is 1. Maps have room. */
void ec_studio_fill(const ec_made_map *map);

/* A clear sky over grey ground. Degrees: azimuth from +z towards +x, elevation of the sun 0 to 90. In units of which the sun at the zenith
 * makes a white plate that lies flat have a radiance of 1. */
void ec_sky_fill(const ec_made_map *map, double azimuth, double elevation);

#endif
