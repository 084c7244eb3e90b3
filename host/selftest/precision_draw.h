/* Random inputs where functions break. */
#ifndef EC_SELFTEST_PRECISION_DRAW_H
#define EC_SELFTEST_PRECISION_DRAW_H

#include "selftest/precision_internal.h"

double ec_draw(ec_precision_random *random); /* in [0, 1) */
static inline double ec_draw_in(ec_precision_random *random, double a, double b) { return a + (b - a) * ec_draw(random); }
double ec_draw_log(ec_precision_random *random, double a, double b); /* between them, every power of ten as often */
static inline uint32_t ec_draw_one(ec_precision_random *random, uint32_t n) { return (uint32_t)(ec_draw(random) * n); }
static inline double ec_draw_sign(ec_precision_random *random, double x) { return ec_draw(random) < 0.5 ? x : -x; }
/* Whole numbers as they lie in a buffer of floats. */
float ec_draw_bits(uint32_t bits);

/* What the sampler gives, often near 0 and 1. */
float ec_draw_unit(ec_precision_random *random);

void ec_put(float *x, const double *v);      /* v, rounded */
void ec_put_unit(float *x, const double *v); /* v / |v| */
/* A unit vector: anywhere; close to an axis, with tiny components or zeros of either sign; in a plane of two axes. */
void ec_draw_direction(ec_precision_random *random, double *v);
/* Likewise with v[2] = z. */
void ec_draw_direction_at(ec_precision_random *random, double z, double *v);
/* A unit vector at this cosine to the unit vector n. */
void ec_draw_direction_about(ec_precision_random *random, const double *n, double cosine, double *v);

#endif
