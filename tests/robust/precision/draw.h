/* Random inputs near the values where functions break. */
#ifndef EC_PRECISION_DRAW_H
#define EC_PRECISION_DRAW_H

#include "base/bits.h"
#include "base/random.h"
#include "robust/precision/internal.h"

double ec_draw_log(uint64_t *random, double a, double b); /* log-uniform between both */
static inline uint32_t ec_draw_one(uint64_t *random, uint32_t n) { return (uint32_t)(ec_random_unit(random) * n); }
static inline double ec_draw_sign(uint64_t *random, double x) { return ec_random_unit(random) < 0.5 ? x : -x; }

/* A random number as the sampler gives it, often near 0 and 1. */
float ec_draw_unit(uint64_t *random);

void ec_put(float *x, const double *v);      /* v, rounded */
void ec_put_unit(float *x, const double *v); /* v / |v| */
/* A unit vector: anywhere; close to an axis, with tiny components or zeros of either sign; or in the plane of two axes. */
void ec_draw_direction(uint64_t *random, double *v);
/* A unit vector of the same kinds with v[2] = z. */
void ec_draw_direction_at(uint64_t *random, double z, double *v);
/* A unit vector with this cosine to the unit vector n. */
void ec_draw_direction_about(uint64_t *random, const double *n, double cosine, double *v);

#endif
