/* Random numbers for tests: the same on every machine. */
#ifndef EC_TESTS_SUPPORT_RANDOM_H
#define EC_TESTS_SUPPORT_RANDOM_H

#include <math.h>

#include "base/random.h"

typedef struct test_random {
    uint64_t state;
} test_random;

/* In (0, 1). */
static inline double test_uniform(test_random *random) { return ec_random_unit(&random->state) + 0x1p-54; }

static inline double test_normal(test_random *random)
{
    double u = test_uniform(random);
    return sqrt(-2 * log(u)) * cos(2 * M_PI * test_uniform(random));
}

#endif
