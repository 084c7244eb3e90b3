/* Discrete distributions as integer alias tables (Walker 1977; Vose 1991), sampled exactly as lib/light.h does. */
#ifndef EC_PACK_ALIAS_H
#define EC_PACK_ALIAS_H

#include <stdint.h>

#include "base/error.h"
#include "shared/scene_buffers.h"

/* weights: n finite values >= 0, not all 0. Fills table and, per entry, the probability with which the kernels really
 * pick it (a sum of exact counts of 32-bit random numbers / 2^32). An entry of weight 0 has probability 0, any other a
 * positive one. Both arrays hold n entries and are the caller's; n < 2^24. */
ec_result ec_alias_build(const double *weights, uint32_t n, ec_alias *table, double *pmf, ec_error *err);

#endif
