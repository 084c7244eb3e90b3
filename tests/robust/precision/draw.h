/* Random inputs where functions break. */
#ifndef EC_PRECISION_DRAW_H
#define EC_PRECISION_DRAW_H

#include "base/bits.h"
#include "base/random.h"
#include "robust/precision/internal.h"

double ec_draw_log(uint64_t *random, double a, double b); /* between them, every power of ten as often */
static inline uint32_t ec_draw_one(uint64_t *random, uint32_t n) { return (uint32_t)(ec_random_unit(random) * n); }
static inline double ec_draw_sign(uint64_t *random, double x) { return ec_random_unit(random) < 0.5 ? x : -x; }

/* What the sampler gives, often near 0 and 1. */
float ec_draw_unit(uint64_t *random);

void ec_put(float *x, const double *v);      /* v, rounded */
void ec_put_unit(float *x, const double *v); /* v / |v| */
/* A unit vector: anywhere; close to an axis, with tiny components or zeros of either sign; in a plane of two axes. */
void ec_draw_direction(uint64_t *random, double *v);
/* Likewise with v[2] = z. */
void ec_draw_direction_at(uint64_t *random, double z, double *v);
/* A unit vector at this cosine to the unit vector n. */
void ec_draw_direction_about(uint64_t *random, const double *n, double cosine, double *v);

#endif
