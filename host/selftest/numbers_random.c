/* Random numbers: the same on every device, and as even as their samplers say. */
#include <math.h>
#include <stdlib.h>

#include "selftest/numbers_run.h"

/* Owen-scrambled Sobol points, written as in the papers and not as in kernels/lib/sampler.h: bits are reversed one by one, and the
 * second dimension comes from its direction numbers v(k + 1) = v(k) ^ v(k) >> 1. */
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

typedef struct pairs {
    uint32_t pixel[EC_NUMBERS_N], index[EC_NUMBERS_N], a[EC_NUMBERS_N], b[EC_NUMBERS_N]; /* a and b in one piece */
} pairs;

static ec_result known_answers(ec_selftest *t, ec_numbers_run *run, pairs *p, ec_error *err)
{
    uint64_t random = 23;
    uint64_t wrong = 0;
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) {
        p->pixel[i] = (uint32_t)ec_random_bits(&random);
        p->index[i] = (uint32_t)ec_random_bits(&random) >> i % 32;
    }
    EC_TRY(ec_numbers_random(t, run, 77, p->pixel, p->index, 5, p->a, err));
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) {
        uint32_t a, b;
        random_pair(77, p->pixel[i], p->index[i], 5, &a, &b);
        wrong += (p->a[i] != a) + (p->b[i] != b);
    }
    return ec_selftest_none(t, "other numbers than on the host", wrong, 2 * EC_NUMBERS_N, NULL, err);
}

/* One of 2^k points in each box of 2^-j by 2^(j - k): all of the first 256, in 128 pixels. */
static ec_result stratified(ec_selftest *t, ec_numbers_run *run, pairs *p, ec_error *err)
{
    enum { LOG = 8, POINTS = 1 << LOG };
    uint64_t empty = 0, boxes = 0;
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) p->pixel[i] = i / POINTS, p->index[i] = i % POINTS;
    EC_TRY(ec_numbers_random(t, run, 1, p->pixel, p->index, 2, p->a, err));
    for (uint32_t first = 0; first < EC_NUMBERS_N; first += POINTS)
        for (uint32_t k = 1; k <= LOG; k++)
            for (uint32_t j = 0; j <= k; j++) {
                uint8_t taken[POINTS] = {0};
                for (uint32_t i = first; i < first + (1u << k); i++)
                    taken[(j ? p->a[i] >> (32 - j) : 0) << (k - j) | (j < k ? p->b[i] >> (32 - (k - j)) : 0)] = 1;
                for (uint32_t i = 0; i < 1u << k; i++) empty += !taken[i];
                boxes += 1u << k;
            }
    return ec_selftest_none(t, "empty boxes of Sobol points", empty, boxes, NULL, err);
}

/* The numbers are from 0 to 1, in 2^-32. */
static double correlation(const uint32_t *x, const uint32_t *y, uint32_t n)
{
    double sum = 0;
    for (uint32_t i = 0; i < n; i++) sum += (x[i] * 0x1p-32 - 0.5) * (y[i] * 0x1p-32 - 0.5);
    return 12 * sum / n;
}

/* Numbers of a pixel, of the next one, of the one in the next row, and the two of a pair: Pearson's rho has a standard error of
 * 1 / sqrt(n). */
static ec_result independent(ec_selftest *t, ec_numbers_run *run, pairs *p, ec_error *err)
{
    uint32_t n = EC_NUMBERS_N - 64;
    double worst = 0, noise = 1 / sqrt(n);
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) p->pixel[i] = i, p->index[i] = 0;
    EC_TRY(ec_numbers_random(t, run, 1, p->pixel, p->index, 0, p->a, err));
    const double rho[] = {correlation(p->a, p->a + 1, n), correlation(p->a, p->a + 64, n), correlation(p->a, p->b, n),
                          correlation(p->b, p->b + 1, n)};
    for (int i = 0; i < 4; i++)
        if (!(fabs(rho[i]) <= fabs(worst))) worst = rho[i];
    return ec_selftest_value(t, "correlation of neighbours", 0, worst, noise, 4 * noise, err);
}

static ec_result below_one(ec_selftest *t, ec_numbers_run *run, ec_error *err)
{
    uint64_t wrong = 0;
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) run->a[i] = ec_float_of_bits(i % 2 ? 0xffffff00u + i / 2 % 256 : i * 0x20001u);
    EC_TRY(ec_numbers_go(t, run, EC_NUMBERS_UNIT, err));
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) wrong += !(run->out[i] >= 0 && run->out[i] < 1);
    return ec_selftest_none(t, "1 or more", wrong, EC_NUMBERS_N, NULL, err);
}

ec_result ec_selftest_random(ec_selftest *t, ec_error *err)
{
    ec_numbers_run run;
    EC_TRY(ec_numbers_open(t, &run, err));
    pairs *p = malloc(sizeof *p);
    ec_result result = p ? known_answers(t, &run, p, err) : ec_fail(err, "out of memory for random numbers");
    if (result == EC_OK) result = stratified(t, &run, p, err);
    if (result == EC_OK) result = independent(t, &run, p, err);
    if (result == EC_OK) result = below_one(t, &run, err);
    free(p);
    ec_numbers_close(&run);
    return result;
}
