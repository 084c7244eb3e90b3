/* Builds discrete distributions for kernels/lib/distribution.h, sampled by inversion in exact integers. */
#ifndef EC_PACK_DISTRIBUTION_H
#define EC_PACK_DISTRIBUTION_H

#include <stdint.h>

#include "shared/scene_buffers.h"

/* Builds a table from n < 2^31 weights, finite and >= 0, not all 0. pmf: the probability with which kernels choose each entry, its share of the
 * 32-bit numbers, 0 only if the weight is. table and pmf are the caller's, n entries each; pmf may be the weights. */
void ec_distribution_build(const double *weights, uint32_t n, ec_distribution_entry *table, double *pmf);

/* Fills entries of a table, without guides, that share the numbers first … end - 1. */
void ec_distribution_share(const double *weights, uint32_t n, uint64_t first, uint64_t end, ec_distribution_entry *table, double *pmf);

/* Fills the guides of a table whose shares were changed: entry i begins at table[i].first, and no entry is empty, except perhaps those behind the
 * last positive one. */
void ec_distribution_guide(uint32_t n, ec_distribution_entry *table);

/* Returns floor(2^64 / share), for choice_stretch of kernels/lib/choice.h; 2^64 - 1 for a share of one number. */
uint64_t ec_distribution_stretch(uint64_t share);

/* Splits it as kernels expect: the high word first. */
static inline void ec_stretch_words(uint64_t stretch, uint32_t words[2])
{
    words[0] = (uint32_t)(stretch >> 32);
    words[1] = (uint32_t)stretch;
}

#endif
