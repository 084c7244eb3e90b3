/* Where a ray meets a triangle in double precision, and how far off a float ray may be. */
#ifndef EC_TESTS_ROBUST_EXACT_HIT_H
#define EC_TESTS_ROBUST_EXACT_HIT_H

#include <math.h>

#include "robust/soups.h"

/* The larger; NaN once there is one, which fmax would pass over. */
static inline double ec_worse(double worst, double value) { return value <= worst || worst != worst ? worst : value; }

/* The line o + t d and a triangle's plane, on the float numbers (Moeller and Trumbore 1997). */
typedef struct exact_hit {
    double t, b1, b2;
    double inside;         /* the least barycentric: < 0 outside */
    double cosine;         /* between line and normal, >= 0; 0: parallel, and nothing else is set */
    double reach;          /* from o to the farthest vertex */
    double least_height;   /* of the triangle */
} exact_hit;

static inline exact_hit exact_meet(const float o[3], const float d[3], const float v[9])
{
    double e1[3], e2[3], normal[3], s[3], p[3], q[3], way[3];
    ec_triangle_normal(v, v + 3, v + 6, normal);
    for (int k = 0; k < 3; k++) {
        e1[k] = (double)v[3 + k] - v[k], e2[k] = (double)v[6 + k] - v[k];
        s[k] = (double)o[k] - v[k], way[k] = d[k];
    }
    ec_cross(way, e2, p);
    ec_cross(s, e1, q);
    double det = ec_dot(e1, p), area = sqrt(ec_dot(normal, normal)), longest = fmax(ec_dot(e1, e1), ec_dot(e2, e2)), third = 0;
    exact_hit h = {.cosine = fabs(ec_dot(normal, way)) / (area * sqrt(ec_dot(way, way)))};
    if (!(det != 0) || !(h.cosine > 0)) return (exact_hit){0};
    h.t = ec_dot(e2, q) / det;
    h.b1 = ec_dot(s, p) / det;
    h.b2 = ec_dot(way, q) / det;
    h.inside = fmin(fmin(h.b1, h.b2), 1 - h.b1 - h.b2);
    for (int k = 0; k < 3; k++) third += (e2[k] - e1[k]) * (e2[k] - e1[k]);
    for (int corner = 0; corner < 3; corner++) {
        double distance2 = 0;
        for (int k = 0; k < 3; k++) distance2 += ((double)v[3 * corner + k] - o[k]) * ((double)v[3 * corner + k] - o[k]);
        h.reach = fmax(h.reach, sqrt(distance2));
    }
    h.least_height = area / sqrt(fmax(longest, third));
    return h;
}

/* What a float ray may be off. A vertex in its frame is a difference and a product of the shear, which itself has two roundings, in
 * two axes, and a depth: 8 u of the reach, twice that with divisions of 2.5 ulp, as OpenCL allows. Along the ray it counts
 * 1 / cosine times, and what the weights are off as much again. */
#define EXACT_T_BOUND (32 * 0x1p-24) /* of reach / cosine */
static inline double exact_t_bound(const exact_hit *h) { return EXACT_T_BOUND * h->reach / h->cosine; }
/* For barycentrics: how far that is on the triangle, over its least height. */
static inline double exact_weight_bound(const exact_hit *h) { return exact_t_bound(h) / h->least_height + EXACT_T_BOUND; }

#endif
