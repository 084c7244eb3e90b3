/* A white floor under an environment map whose light comes from next to nowhere. */
#ifndef EC_SELFTEST_SUN_H
#define EC_SELFTEST_SUN_H

#include "selftest/cases.h"

/* `sky` everywhere but in rows [dark, height), which are 0, and in one texel of row sun_y. */
typedef struct ec_sun_map {
    uint32_t width, height, dark;
    float sky, sun;
    uint32_t sun_y;
} ec_sun_map;

/* Integral of cos over the hemisphere about +y of the bilinear tent of a texel in row y, of height 1 at its centre. */
double ec_sun_irradiance(uint32_t width, uint32_t height, uint32_t y);

/* A row: the radiance of the floor. */
ec_result ec_sun_row(ec_selftest *t, const char *what, const ec_sun_map *map, double expected, ec_error *err);

#endif
