/* Intersection of a ray and a triangle in double precision, and error bounds for a float ray. */
#ifndef EC_TESTS_ROBUST_EXACT_HIT_H
#define EC_TESTS_ROBUST_EXACT_HIT_H

#include <math.h>

#include "robust/soups.h"

/* The larger of both; NaN if one is NaN, which fmax would ignore. */
static inline double ec_worse(double worst, double value) { return value <= worst || worst != worst ? worst : value; }

/* Intersects the line o + t d and a triangle's plane, from the float numbers (Moeller and Trumbore 1997). */
typedef struct exact_hit {
    double t, b1, b2;
    double inside;         /* the smallest barycentric coordinate: < 0 outside */
    double cosine;         /* between the line and the normal, >= 0; 0: parallel, and nothing else is set */
    double reach;          /* distance from o to the farthest vertex */
    double least_height;   /* the triangle's normal */
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

/* Error bound of a float hit. A vertex in the ray's frame is a difference and a product with the shear, which has two roundings itself, in
 * two axes, and a depth: 8 u of the reach. Divisions of 2.5 ulp, which OpenCL allows, double that. Along the ray the error counts 1 /
 * cosine times, and the error of the weights adds as much again. */
#define EXACT_T_BOUND (32 * 0x1p-24) /* times reach / cosine */
static inline double exact_t_bound(const exact_hit *h) { return EXACT_T_BOUND * h->reach / h->cosine; }
/* Error bound of barycentrics: the error on the triangle over its smallest height. */
static inline double exact_weight_bound(const exact_hit *h) { return exact_t_bound(h) / h->least_height + EXACT_T_BOUND; }

#endif
