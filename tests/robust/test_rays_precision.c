/* tier: full */
/* Hits against double precision: at grazing angles, and on slivers. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "robust/cases.h"
#include "robust/exact_hit.h"
#include "robust/leave.h"
#include "selftest/tracer.h"

/* A ray to a point within a triangle, from `distance` away, with this cosine to its normal. */
static void put_ray_at(ec_tracer *r, uint64_t *random, uint32_t i, double cosine, double distance)
{
    const float *v = ec_tracer_triangle(r, i % r->soup->count);
    double normal[3], d[3], to[3], from[3], b1 = ec_random_unit(random), b2 = ec_random_unit(random) * (1 - b1), along;
    const double nowhere[3] = {0, 0, 0};
    float o[3], way[3];
    ec_triangle_normal(v, v + 3, v + 6, normal);
    double area = sqrt(ec_dot(normal, normal)), length = 0;
    ec_direction(random, d);
    along = ec_dot(d, normal) / area;
    for (int k = 0; k < 3; k++) d[k] -= along * normal[k] / area;
    length = sqrt(ec_dot(d, d));
    for (int k = 0; k < 3; k++) {
        d[k] = sqrt(1 - cosine * cosine) * d[k] / length + (i & 1 ? cosine : -cosine) * normal[k] / area;
        to[k] = v[k] + b1 * ((double)v[3 + k] - v[k]) + b2 * ((double)v[6 + k] - v[k]);
        from[k] = to[k] - distance * d[k];
        o[k] = (float)from[k];
    }
    ec_float_direction(nowhere, d, way);
    ec_tracer_ray(r, i, o, way, EC_NO_ID);
}

typedef struct errors {
    double t, weight;          /* largest errors, in units of their bounds */
    uint64_t hits, rays, lost; /* lost: misses of triangles that are certainly hit */
} errors;

static void compare(ec_tracer *r, uint32_t i, errors *e)
{
    float o[3], d[3];
    ec_traced h = ec_tracer_hit(r, i);
    ec_tracer_given(r, i, o, d);
    exact_hit aimed = exact_meet(o, d, ec_tracer_triangle(r, i % r->soup->count));
    bool certain = aimed.cosine > 0 && aimed.inside > 2 * exact_weight_bound(&aimed) && aimed.t > 2 * exact_t_bound(&aimed);
    e->rays++;
    e->lost += certain && (h.prim == EC_NO_ID || h.t > aimed.t + exact_t_bound(&aimed));
    if (h.prim == EC_NO_ID) return;
    exact_hit x = exact_meet(o, d, ec_tracer_triangle(r, h.prim));
    e->hits++;
    if (!(x.cosine > 0)) return; /* the plane contains the ray: t is arbitrary */
    e->t = ec_worse(e->t, fabs(h.t - x.t) / (x.reach / x.cosine));
    double off = ec_worse(fabs(h.b1 - x.b1), fabs(h.b2 - x.b2));
    e->weight = ec_worse(e->weight, off * EXACT_T_BOUND / exact_weight_bound(&x));
}

/* The error of t may grow as 1 / cosine, which float cannot avoid; no hit may be lost because of it. */
static ec_result grazing_case(ec_selftest *t, ec_error *err)
{
    const double nowhere[3] = {0, 0, 0};
    const uint32_t rays = EC_TRACER_RAYS;
    uint64_t random = 7;
    errors all = {0};
    double worst = 0;
    char note[64] = "";
    ec_tracer *r;
    ec_soup soup;
    EC_TRY(ec_tracer_of(t, &r, err));
    EC_TRY(ec_soup_random(&random, 48, 1, 3, nowhere, &soup, err));
    ec_result result = ec_tracer_build(r, &soup, err);
    for (int power = 1; power <= 7 && result == EC_OK; power++) {
        for (uint32_t i = 0; i < rays; i++) put_ray_at(r, &random, i, pow(10, -power), pow(10, ec_random_between(&random, -1, 1)));
        for (uint32_t a = 0; ec_tracer_next(r, &a, rays, &result, err); a++) {
            for (uint32_t i = 0; i < rays; i++) compare(r, i, &all);
        }
        if (all.t > worst) snprintf(note, sizeof note, "of reach / cosine; at a cosine of 1e-%d", power);
        worst = all.t;
    }
    ec_soup_free(&soup);
    EC_TRY(result);
    EC_TRY(ec_selftest_largest(t, "t", all.t, EXACT_T_BOUND, note, err));
    return ec_selftest_none(t, "lost", all.lost, all.rays, NULL, err);
}

/* A long edge, and a corner whose distance from it is smaller by the aspect ratio. */
static void put_sliver(uint64_t *random, double aspect, float v[9])
{
    double e[3], side[3], along = ec_random_unit(random);
    ec_direction(random, e);
    ec_direction(random, side);
    for (int k = 0; k < 3; k++) {
        double at = ec_random_between(random, -1, 1);
        v[k] = (float)at;
        v[3 + k] = (float)(at + e[k]);
        v[6 + k] = (float)(at + along * e[k] + side[k] / aspect);
    }
}

/* Distance from a triangle's plane, in units of the kernels' own bound. */
static double off_plane(uint32_t i, const float v[9])
{
    double normal[3], allowed = 0, off = 0;
    ec_triangle_normal(v, v + 3, v + 6, normal);
    for (int k = 0; k < 3; k++) {
        off += normal[k] * ((double)left(EC_LEAVE_P + k, i) - v[k]);
        allowed += fabs(normal[k]) * left(EC_LEAVE_ERROR + k, i);
    }
    return fabs(off) / allowed;
}

/* Hits on slivers: weights are as exact as the triangle's heights allow, which from 1e6 on means arbitrary. Points are on the plane to the
 * bound that offsets rely on. */
static ec_result slivers(ec_selftest *t, double aspect, bool has_weights, ec_error *err)
{
    enum { SLIVERS = 48 };
    char what[48];
    uint64_t random = 8;
    errors all = {0};
    double off = 0;
    ec_tracer *r;
    ec_soup soup;
    EC_TRY(ec_tracer_of(t, &r, err));
    EC_TRY(ec_soup_make(SLIVERS, &soup, err));
    for (int i = 0; i < SLIVERS; i++) put_sliver(&random, aspect, soup.vertices + 9 * i);
    ec_result result = ec_tracer_build(r, &soup, err);
    for (uint32_t i = 0; i < EC_TRACER_RAYS; i++)
        put_ray_at(r, &random, i, ec_random_between(&random, 0.1, 1), ec_random_between(&random, 0.1, 4));
    for (uint32_t a = 0; ec_tracer_next(r, &a, EC_TRACER_RAYS, &result, err); a++) {
        for (uint32_t i = 0; i < EC_TRACER_RAYS; i++) compare(r, i, &all);
    }
    for (uint32_t i = 0; i < EC_TRACER_RAYS; i++) /* a miss still needs a triangle to leave */
        if (ec_tracer_hit(r, i).prim == EC_NO_ID) set_hit(r, i, 0, 0, 0);
    if (result == EC_OK) result = leave_hits(r, err);
    for (uint32_t i = 0; i < EC_TRACER_RAYS; i++)
        off = ec_worse(off, off_plane(i, ec_tracer_triangle(r, ec_tracer_hit(r, i).prim)));
    ec_soup_free(&soup);
    EC_TRY(result);
    snprintf(what, sizeof what, "1e%.0f, weights", log10(aspect));
    if (has_weights) EC_TRY(ec_selftest_largest(t, what, all.weight, EXACT_T_BOUND, "where the height is the reach", err));
    snprintf(what, sizeof what, "1e%.0f, points off the plane", log10(aspect));
    /* the bound is 9 u of the coordinates; this is the share of it in units of u */
    return ec_selftest_largest(t, what, off * 9 * 0x1p-24, 9 * 0x1p-24, "of coordinates", err);
}

static ec_result slivers_case(ec_selftest *t, ec_error *err)
{
    EC_TRY(slivers(t, 1e3, true, err));
    EC_TRY(slivers(t, 1e6, false, err));
    return slivers(t, 1e8, false, err);
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"rays/grazing", false, grazing_case, "epsilons on the cosine or the determinant lose grazing hits"},
        {"rays/slivers", false, slivers_case, "needles shade with wild barycentrics (pbrt-v4's TEST(Triangle, BadCases))"},
    };
    return RUN_CASES(cases);
}
