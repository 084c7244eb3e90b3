/* SplitMix64 (Steele et al. 2014): random numbers for the host, and seeds that differ in every bit. */
#ifndef EC_BASE_RANDOM_H
#define EC_BASE_RANDOM_H

#include <stdint.h>

#define EC_RANDOM_STEP UINT64_C(0x9e3779b97f4a7c15) /* golden ratio */

static inline uint64_t ec_random_mix(uint64_t x)
{
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

static inline uint64_t ec_random_bits(uint64_t *state) { return ec_random_mix(*state += EC_RANDOM_STEP); }

/* Returns a number in [0, 1). */
static inline double ec_random_unit(uint64_t *state) { return (double)(ec_random_bits(state) >> 11) * 0x1p-53; }

static inline double ec_random_between(uint64_t *state, double low, double high)
{
    return low + (high - low) * ec_random_unit(state);
}

#endif
