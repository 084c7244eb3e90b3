/* Triangles for cases about rays. */
#ifndef EC_SELFTEST_SOUP_H
#define EC_SELFTEST_SOUP_H

#include "scene/scene.h"

typedef struct ec_soup {
    uint32_t count;
    float *vertices;       /* 9 floats per triangle; owned */
} ec_soup;
ec_result ec_soup_make(uint32_t count, ec_soup *soup, ec_error *err);
void ec_soup_free(ec_soup *soup); /* zero-initialised is fine */
float ec_soup_largest(const ec_soup *soup); /* the largest |coordinate| */

ec_result ec_soup_from_scene(const ec_scene *scene, ec_soup *soup, ec_error *err);
/* Makes a closed ball of 8 * 4^levels triangles around the origin, with bumps of that height, stretched along the axes and moved. */
ec_result ec_soup_ball(int levels, double bumps, const double stretch[3], const double centre[3], ec_soup *soup, ec_error *err);

#endif
