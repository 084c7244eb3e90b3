/* Discrete distributions for kernels/lib/distribution.h, sampled by inversion in exact integers. */
#ifndef EC_PACK_DISTRIBUTION_H
#define EC_PACK_DISTRIBUTION_H

#include <stdint.h>

#include "shared/scene_buffers.h"

/* weights: n finite values >= 0, not all 0; n < 2^31. Fills the table and the probability with which the kernels pick each entry: its
 * share of the 32-bit numbers, 0 only where the weight is. Arrays hold n entries and are the caller's; pmf may be the weights. */
void ec_distribution_build(const double *weights, uint32_t n, ec_distribution_entry *table, double *pmf);

/* Fills what these entries have of a table, without guides: numbers first … end - 1. */
void ec_distribution_share(const double *weights, uint32_t n, uint64_t first, uint64_t end, ec_distribution_entry *table, double *pmf);

/* The guides of a table whose shares are changed: entry i's begins at table[i].first, and none is empty but perhaps behind the last. */
void ec_distribution_guide(uint32_t n, ec_distribution_entry *table);

/* floor(2^64 / share), for choice_stretch of kernels/lib/choice.h; 2^64 - 1 for a share of one number. */
uint64_t ec_distribution_stretch(uint64_t share);

/* As kernels have it: the high word first. */
static inline void ec_stretch_words(uint64_t stretch, uint32_t words[2])
{
    words[0] = (uint32_t)(stretch >> 32);
    words[1] = (uint32_t)stretch;
}

#endif
