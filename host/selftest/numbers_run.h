/* Evaluates numerical functions on the device, over arrays. Inside host/selftest only. */
#ifndef EC_SELFTEST_NUMBERS_RUN_H
#define EC_SELFTEST_NUMBERS_RUN_H

#include "base/bits.h"
#include "base/random.h"
#include "selftest/cases.h"
#include "shared/selftest.h"

#define EC_NUMBERS_N 32768u /* values of one run */

typedef struct ec_numbers_run {
    cl_program program;
    float *a, *b, *c, *out; /* EC_NUMBERS_N each */
} ec_numbers_run;

ec_result ec_numbers_open(ec_selftest *t, ec_numbers_run *run, ec_error *err); /* on failure there is nothing to close */
void ec_numbers_close(ec_numbers_run *run);
/* Computes out = function(a, b, c); function: an ec_numbers_function. */
ec_result ec_numbers_go(ec_selftest *t, ec_numbers_run *run, uint32_t function, ec_error *err);
/* Computes pairs of random integers for n values of `index` and `pixel`. */
ec_result ec_numbers_random(ec_selftest *t, ec_numbers_run *run, uint32_t seed, const uint32_t *pixel,
                            const uint32_t *index, uint32_t pair, uint32_t *pairs, ec_error *err);

/* Returns a float of random size for which products, quotients and their rounding errors are normal. */
static inline float ec_any_float(uint64_t *random)
{
    uint32_t bits = (uint32_t)ec_random_bits(random);
    return ec_float_of_bits((bits & 0x807fffffu) | (127 - 38 + (bits >> 23) % 77) << 23);
}

#endif
