/* Finds lights that a ray can be aimed at. Inside host/rare only. */
#ifndef EC_RARE_SOURCES_H
#define EC_RARE_SOURCES_H

#include "rare/lights.h"

/* Returns whether it is a part of an environment so small that a ray can be aimed at it. */
bool ec_rare_light_is_sun(const ec_rare_light *light);

/* Makes a source of one of a light's lamps that stands for one of so many parts of all of them. */
void ec_rare_source_of_lamp(const ec_rare_light *light, uint32_t lamp, uint32_t parts, ec_rare_source *source);

/* Adds directions of a sky. radiance: of each octant of the map's directions, by the signs of x, y and z from the lowest bit on, set if negative. */
void ec_rare_sky_find(const double radiance[8], ec_rare_lights *all);

/* Adds them, once the environment's parts and lamps are among the lights. */
void ec_rare_sources_find(const ec_scene *scene, ec_rare_lights *all);

#endif
