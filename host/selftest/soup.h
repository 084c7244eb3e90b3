/* Triangles for cases about rays, and what a ray does to them in double precision. Inside host/selftest only. */
#ifndef EC_SELFTEST_SOUP_H
#define EC_SELFTEST_SOUP_H

#include "base/random.h"
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
double ec_dot(const double a[3], const double b[3]);
/* The larger; NaN once there is one, which fmax would pass over. */
static inline double ec_worse(double worst, double value) { return value <= worst || worst != worst ? worst : value; }
void ec_direction(uint64_t *random, double d[3]); /* uniform */

/* The line o + t d and a triangle's plane, on the float numbers (Moeller and Trumbore 1997). */
typedef struct ec_exact_hit {
    double t, b1, b2;
    double inside;         /* the least barycentric: < 0 outside */
    double cosine;         /* between line and normal, >= 0; 0: parallel, and nothing else is set */
    double reach;          /* from o to the farthest vertex */
    double least_height;   /* of the triangle */
} ec_exact_hit;
ec_exact_hit ec_exact_meet(const float o[3], const float d[3], const float v[9]);

/* What a float ray may be off. A vertex in its frame is a difference and a product of the shear, which itself has two roundings, in
 * two axes, and a depth: 8 u of the reach, twice that with divisions of 2.5 ulp, as OpenCL allows. Along the ray it counts
 * 1 / cosine times, and what the weights are off as much again. */
#define EC_T_BOUND (32 * 0x1p-24) /* of reach / cosine */
static inline double ec_exact_t_bound(const ec_exact_hit *h) { return EC_T_BOUND * h->reach / h->cosine; }
/* Of barycentrics: how far that is on the triangle, over its least height. */
static inline double ec_exact_weight_bound(const ec_exact_hit *h) { return ec_exact_t_bound(h) / h->least_height + EC_T_BOUND; }

#endif
