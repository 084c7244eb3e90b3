/* A white floor under an environment map whose light comes from almost a single point. */
#ifndef EC_SELFTEST_SUN_H
#define EC_SELFTEST_SUN_H

#include "selftest/cases.h"

/* The map is `sky` everywhere, except for rows [dark, height), which are 0, and one texel `sun` in row sun_y. */
typedef struct ec_sun_map {
    uint32_t width, height, dark;
    float sky, sun;
    uint32_t sun_y;
} ec_sun_map;

/* Returns the integral of cos over the hemisphere about +y of a texel's bilinear tent, of height 1 at its centre in row y. */
double ec_sun_irradiance(uint32_t width, uint32_t height, uint32_t y);

/* Adds a row with the radiance of the floor. */
ec_result ec_sun_row(ec_selftest *t, const char *what, const ec_sun_map *map, double expected, ec_error *err);

#endif
