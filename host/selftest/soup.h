/* Triangles for cases about rays, and what a ray does to them in double precision. Inside host/selftest only. */
#ifndef EC_SELFTEST_SOUP_H
#define EC_SELFTEST_SOUP_H

#include "base/random.h"
#include "base/vec3.h"
#include "scene/scene.h"

typedef struct ec_soup {
    uint32_t count;
    float *vertices;       /* 9 a triangle; owned */
} ec_soup;
ec_result ec_soup_make(uint32_t count, ec_soup *soup, ec_error *err);
void ec_soup_free(ec_soup *soup); /* zero-initialised is fine */
float ec_soup_largest(const ec_soup *soup); /* |coordinate| */

ec_result ec_soup_from_scene(const ec_scene *scene, ec_soup *soup, ec_error *err);
/* Corners within `edge` of points within `spread` of `centre`; none without area. May be fewer than asked for. */
ec_result ec_soup_random(uint64_t *random, uint32_t count, double edge, double spread, const double centre[3],
                         ec_soup *soup, ec_error *err);
/* A closed ball of 8 * 4^levels triangles about the origin, with bumps of that height, stretched along the axes and moved. */
ec_result ec_soup_ball(int levels, double bumps, const double stretch[3], const double centre[3], ec_soup *soup, ec_error *err);

/* Twice its area, along its normal. */
void ec_triangle_normal(const float v[9], double normal[3]);
void ec_direction(uint64_t *random, double d[3]); /* uniform */

#endif
