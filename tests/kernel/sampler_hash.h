/* Host copy of hash_u in kernels/lib/sampler.h, which gives the digits below those of a rescaled number. */
#ifndef TESTS_SAMPLER_HASH_H
#define TESTS_SAMPLER_HASH_H

#include <stdint.h>

static inline uint32_t sampler_hash(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x21f0aaadu;
    x ^= x >> 15;
    x *= 0x735a2d97u;
    x ^= x >> 15;
    return x;
}

#endif
