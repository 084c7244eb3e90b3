/* Random numbers must be the same on every device. */
#include "selftest/numbers_run.h"

/* Owen-scrambled Sobol points, written as in the papers rather than as in kernels/lib/sampler.h: bits are reversed one by one, and the second
 * dimension comes from its direction numbers v(k + 1) = v(k) ^ v(k) >> 1. */
static uint32_t mixed(uint32_t x)
{
    x = (x ^ x >> 16) * 0x21f0aaadu;
    x = (x ^ x >> 15) * 0x735a2d97u;
    return x ^ x >> 15;
}

static uint32_t reversed(uint32_t x)
{
    uint32_t r = 0;
    for (int bit = 0; bit < 32; bit++) r |= (x >> bit & 1) << (31 - bit);
    return r;
}

static uint32_t scrambled(uint32_t x, uint32_t seed)
{
    x = reversed(x);
    x ^= x * 0x3d20adeau;
    x = (x + seed) * (seed >> 16 | 1);
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reversed(x);
}

static uint32_t second_sobol(uint32_t index)
{
    uint32_t value = 0;
    for (uint32_t v = 0x80000000u; index; index >>= 1, v ^= v >> 1)
        if (index & 1) value ^= v;
    return value;
}

static void random_pair(uint32_t seed, uint32_t pixel, uint32_t index, uint32_t pair, uint32_t *a, uint32_t *b)
{
    uint32_t key = mixed(mixed(mixed(pixel) ^ seed) ^ pair * 0x9e3779b9u), shuffled = scrambled(index, key);
    *a = scrambled(reversed(shuffled), key * 0x2c1b3c6du + 0x68bc21ebu);
    *b = scrambled(second_sobol(shuffled), key * 0x297a2d39u + 0x02e5be93u);
}

ec_result ec_selftest_random(ec_selftest *t, ec_error *err)
{
    enum { SEED = 77, PAIR = 5 };
    static uint32_t pixel[EC_NUMBERS_N], index[EC_NUMBERS_N], got[2 * EC_NUMBERS_N];
    uint64_t random = 23, wrong = 0;
    ec_numbers_run run;
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) {
        pixel[i] = (uint32_t)ec_random_bits(&random);
        index[i] = (uint32_t)ec_random_bits(&random) >> i % 32;
    }
    EC_TRY(ec_numbers_open(t, &run, err));
    ec_result result = ec_numbers_random(t, &run, SEED, pixel, index, PAIR, got, err);
    for (uint32_t i = 0; i < EC_NUMBERS_N && result == EC_OK; i++) {
        uint32_t a, b;
        random_pair(SEED, pixel[i], index[i], PAIR, &a, &b);
        wrong += (got[i] != a) + (got[EC_NUMBERS_N + i] != b);
    }
    ec_numbers_close(&run);
    EC_TRY(result);
    return ec_selftest_none(t, "other numbers than on the host", wrong, 2 * EC_NUMBERS_N, NULL, err);
}
