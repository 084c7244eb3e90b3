/* Random triangles and directions. */
#ifndef EC_TESTS_ROBUST_SOUPS_H
#define EC_TESTS_ROBUST_SOUPS_H

#include <math.h>

#include "base/random.h"
#include "base/vec3.h"
#include "selftest/soup.h"

/* A uniform direction. */
static inline void ec_direction(uint64_t *random, double d[3])
{
    double z = ec_random_between(random, -1, 1), angle = ec_random_between(random, -3.14159265358979323846, 3.14159265358979323846);
    double r = sqrt(1 - z * z);
    d[0] = r * cos(angle);
    d[1] = r * sin(angle);
    d[2] = z;
}

/* Triangles with corners within `edge` of points within `spread` of `centre`; none without area. There may be fewer than asked for. */
static inline ec_result ec_soup_random(uint64_t *random, uint32_t count, double edge, double spread, const double centre[3],
                         ec_soup *soup, ec_error *err)
{
    uint32_t kept = 0;
    EC_TRY(ec_soup_make(count, soup, err));
    for (uint32_t i = 0; i < count; i++) {
        float *v = soup->vertices + 9 * (size_t)kept;
        double at[3], normal[3];
        for (int k = 0; k < 3; k++) at[k] = centre[k] + ec_random_between(random, -spread, spread);
        for (int k = 0; k < 9; k++) v[k] = (float)(at[k % 3] + ec_random_between(random, -edge, edge));
        ec_triangle_normal(v, v + 3, v + 6, normal);
        kept += ec_dot(normal, normal) > 0;
    }
    soup->count = kept;
    return EC_OK;
}

#endif
