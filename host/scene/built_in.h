/* Environments that need no file: maps made by formulas. */
#ifndef EC_SCENE_BUILT_IN_H
#define EC_SCENE_BUILT_IN_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

#define EC_STUDIO "studio"
#define EC_SKY "sky:"

/* Pixels like those of ec_environment; rgb is malloc'ed. */
typedef struct ec_made_map {
    uint32_t width, height;
    float *rgb;
} ec_made_map;

/* Tells whether spec is "studio" or "sky:AZIMUTH,ELEVATION", and so not the name of a file. */
bool ec_is_built_in(const char *spec);
ec_result ec_built_in_make(const char *spec, ec_made_map *map, ec_error *err);

/* Computes the unit direction of the centre of texel (x, y). */
void ec_made_map_direction(const ec_made_map *map, uint32_t x, uint32_t y, double d[3]);
double ec_made_map_solid_angle(const ec_made_map *map, uint32_t y); /* steradians of a texel in that row */

/* Fills a map with grey walls and five soft boxes, for a subject that faces +z; the mean radiance over all directions is 1. map->rgb must be
 * allocated. */
void ec_studio_fill(const ec_made_map *map);

/* Fills a map with a clear sky over grey ground. Degrees: azimuth from +z towards +x, elevation of the sun 0 to 90. The unit is such that the sun at
 * the zenith gives a white horizontal plate a radiance of 1. */
void ec_sky_fill(const ec_made_map *map, double azimuth, double elevation);

#endif
