/* Random numbers for tests: the same on every machine. */
#ifndef EC_TESTS_SUPPORT_RANDOM_H
#define EC_TESTS_SUPPORT_RANDOM_H

#include <math.h>
#include <stdint.h>

typedef struct test_random {
    uint64_t state;
} test_random;

/* In (0, 1). SplitMix64: Steele et al. 2014. */
static inline double test_uniform(test_random *random)
{
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53 + 0x1p-54;
}

static inline double test_normal(test_random *random)
{
    double u = test_uniform(random);
    return sqrt(-2 * log(u)) * cos(2 * M_PI * test_uniform(random));
}

#endif
