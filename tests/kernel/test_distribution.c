/* tier: quick */
/* Distributions sampled by inversion: every entry has its share of the 2^32 numbers, exactly and in order, and kernels find it. */
#include "kernel/kernel_run.h"
#include "kernel/sampler_hash.h"
#include "pack/distribution.h"

#define MOST 6000u
#define NUMBERS (3 * 8192u)

static ec_cl cl;
static cl_program program;
static double weights[MOST], pmf[MOST];
static ec_distribution_entry table[MOST];
static uint32_t r[NUMBERS], expected[NUMBERS], entry[NUMBERS];
static float left[NUMBERS];
static double share_left[NUMBERS];

/* to_unit of the hash: the digits below a number's own. */
static double digits_of(uint32_t x) { return (sampler_hash(x) >> 8) * 0x1p-24; }

static void make_weights(uint32_t n, int kind)
{
    for (uint32_t i = 0; i < n; i++) {
        weights[i] = kind == 0 ? 1 : pow(10, 30 * test_random_in(0, 1) - 20);
        if (kind == 2 && i % 3 != 1) weights[i] = 0; /* often the first and the last */
        if (kind == 3 && i != n / 2) weights[i] = 0;
    }
    if (kind == 4) weights[n / 3] = 1e300;
}

/* Shares are consecutive and follow the weights. Collects the first, the last and a random number of each. */
static uint32_t check_shares(uint32_t n)
{
    double sum = 0, worst = 0;
    uint64_t first = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < n; i++) sum += weights[i];
    for (uint32_t i = 0; i < n; i++) {
        uint64_t share = (uint64_t)(pmf[i] * 0x1p32);
        worst = fmax(worst, fabs(pmf[i] - weights[i] / sum));
        CHECK_MSG((weights[i] > 0) == (share > 0), "entry %u of %u: weight %g, share %llu", i, n, weights[i], (unsigned long long)share);
        CHECK_MSG(!share || table[i].first == first, "entry %u of %u begins at %u, not at %llu", i, n, table[i].first, (unsigned long long)first);
        const uint64_t of[3] = {0, share - 1, (uint64_t)(test_random_in(0, 1) * (double)share)};
        for (int k = 0; share && k < 3; k++) {
            r[count] = (uint32_t)(first + of[k]);
            share_left[count] = ((double)of[k] + digits_of(r[count])) / (double)share;
            expected[count++] = i;
        }
        first += share;
    }
    CHECK_MSG(first == (uint64_t)1 << 32, "%u entries share %llu numbers", n, (unsigned long long)first);
    CHECK_MSG(worst <= (n + 1) * 0x1p-32, "%u entries: a probability is off by %g", n, worst);
    return count;
}

static void check(uint32_t n, int kind)
{
    make_weights(n, kind);
    ec_distribution_build(weights, n, table, pmf);
    uint32_t count = check_shares(n), all = NUMBERS, wrong = 0, off = 0;
    if (test_failures || !KERNEL_CALL(&cl, program, "sample_distribution", all / 8, SCALAR(all), IN(table, n), SCALAR(n), IN(r, NUMBERS),
                                      OUT(entry, NUMBERS), OUT(left, NUMBERS)))
        return;
    for (uint32_t i = 0; i < count; i++) {
        wrong += entry[i] != expected[i];
        off += !(fabs(left[i] - share_left[i]) <= 0x1p-21 && left[i] < 1); /* four roundings and a quotient of 2.5 ulp */
    }
    const uint32_t positive = kind < 2 || kind == 4;
    if (positive && n <= 9) { /* found by linear search */
        uint32_t others = 0;
        if (!KERNEL_CALL(&cl, program, "pick_few", all / 8, SCALAR(all), IN(table, n), SCALAR(n), IN(r, NUMBERS), OUT(entry, NUMBERS))) return;
        for (uint32_t i = 0; i < NUMBERS; i++) others += entry[i] != 0;
        CHECK_MSG(others == 0, "%u entries of kind %d: %u numbers find another one of a short table", n, kind, others);
    }
    CHECK_MSG(wrong == 0 && off == 0, "%u entries of kind %d: of %u numbers %u find another entry, %u another place", n, kind, count, wrong, off);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    program = kernel_build(&cl, "distribution", 8, "");
    for (int kind = 0; kind < 5 && !test_failures; kind++)
        for (uint32_t n = 1 + (kind == 2); n <= MOST; n = n * 3 + (uint32_t)kind) check(n, kind);
    if (program) clReleaseProgram(program);
    ec_cl_close(&cl);
    TEST_END();
}
