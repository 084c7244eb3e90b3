/* tier: quick */
/* Random numbers that choose and are used again: after evenly spaced numbers have chosen, the rescaled ones are evenly spaced for each
 * choice, in order, and whole numbers are rescaled exactly. */
#include "device/light_share.h"
#include "kernel/kernel_run.h"
#include "kernel/sampler_hash.h"
#include "pack/distribution.h"

#define NUMBERS (1u << 16)
#define LANES_TRIED 8

static ec_cl cl;
static cl_program program;
static uint32_t r[NUMBERS], rest[NUMBERS], which[NUMBERS], stretched[NUMBERS];
static float left[NUMBERS];
static uint32_t numbers = NUMBERS;

/* (rest + hash / 2^32) 2^32 / share, with the quotient of the powers truncated to a whole number. */
static void check_stretch(uint64_t share)
{
    const uint64_t factor = ec_distribution_stretch(share);
    const uint32_t words[2] = {(uint32_t)(factor >> 32), (uint32_t)factor};
    uint32_t wrong = 0;
    CHECK_MSG(factor == (share == 1 ? UINT64_MAX : (uint64_t)(((unsigned __int128)1 << 64) / share)), "factor of %llu", (unsigned long long)share);
    for (uint32_t i = 0; i < NUMBERS; i++) {
        r[i] = (uint32_t)(test_random_u64() >> 32);
        rest[i] = i == 0 ? 0 : i == 1 ? (uint32_t)(share - 1) : (uint32_t)((test_random_u64() >> 32) * share >> 32);
    }
    if (!KERNEL_CALL(&cl, program, "stretch", NUMBERS / LANES_TRIED, SCALAR(numbers), IN(rest, NUMBERS), IN(words, 2), IN(r, NUMBERS),
                     OUT(stretched, NUMBERS)))
        return;
    for (uint32_t i = 0; i < NUMBERS; i++) {
        const unsigned __int128 at = ((unsigned __int128)rest[i] << 32 | sampler_hash(r[i])) * factor;
        wrong += at >> 96 != 0 || stretched[i] != (uint32_t)(at >> 64);
    }
    CHECK_MSG(!wrong, "%u numbers of a share of %llu are stretched to others", wrong, (unsigned long long)share);
}

/* Numbers 2^16 apart. Among n numbers that choose one thing, the k-th is in its interval of n except for the interval's ends, that is
 * within 1 / n, plus half of that for the digits from a hash. */
static void check_chain(const float *p, uint32_t count)
{
    double chance[8], remains = 1;
    uint32_t seen[8] = {0}, total[8] = {0}, disordered = 0;
    double worst = 0, last[8] = {0};
    for (uint32_t i = 0; i < NUMBERS; i++) r[i] = i << 16;
    if (!KERNEL_CALL(&cl, program, "chain", NUMBERS / LANES_TRIED, SCALAR(numbers), IN(r, NUMBERS), IN(p, count), SCALAR(count),
                     OUT(which, NUMBERS), OUT(left, NUMBERS)))
        return;
    for (uint32_t i = 0; i < NUMBERS; i++) total[which[i]]++;
    for (uint32_t i = 0; i < NUMBERS; i++) {
        const uint32_t w = which[i];
        worst = fmax(worst, fabs(left[i] - (double)seen[w]++ / total[w]) * total[w]);
        disordered += !(left[i] >= last[w] && left[i] < 1);
        last[w] = left[i];
    }
    for (uint32_t i = 0; i <= count; i++) {
        chance[i] = i < count ? remains * (double)p[i] : remains;
        remains -= chance[i];
        CHECK_MSG(fabs(total[i] - chance[i] * NUMBERS) <= 2, "thing %u of %u is chosen %u times, not %.1f", i, count, total[i], chance[i] * NUMBERS);
    }
    CHECK_MSG(worst <= 1.5 && !disordered, "%u things: off by %.2f places, %u out of order", count, worst, disordered);
}

/* Few numbers remain, and their lower digits are uniform: the mean is within 4 standard errors, sqrt(1 / 12 / n). */
static void check_fill(void)
{
    uint32_t all = 3;
    double sum = 0, least = 1, most = 0;
    for (uint32_t i = 0; i < NUMBERS; i++) r[i] = (uint32_t)(test_random_u64() >> 32), rest[i] = i % all;
    if (!KERNEL_CALL(&cl, program, "rests", NUMBERS / LANES_TRIED, SCALAR(numbers), IN(rest, NUMBERS), SCALAR(all), IN(r, NUMBERS), OUT(left, NUMBERS)))
        return;
    for (uint32_t i = 0; i < NUMBERS; i++) {
        CHECK(left[i] * 3 >= (float)rest[i] - 1e-6f && left[i] * 3 <= (float)rest[i] + 1.000001f);
        sum += left[i] / NUMBERS;
        least = fmin(least, left[i]);
        most = fmax(most, left[i]);
    }
    CHECK_MSG(fabs(sum - 0.5) < 4 * sqrt(1.0 / 12 / NUMBERS) && least < 1e-3 && most > 1 - 1e-3 && most < 1, "mean %.4f, from %g to %g", sum, least, most);
}

/* Numbers 2^16 apart. A share of all, `share`, is for lights at infinity, and maps evenly and in order to the lower half of the table, the
 * others to the upper half. With equal halves numbers do not change. */
static void check_share(double share)
{
    ec_params params = {.environment_pmf = 0.5f};
    uint32_t wrong = 0;
    ec_light_share_set(&params, 0.25);
    ec_light_share_set(&params, share);
    CHECK_MSG(params.environment_pmf == (float)share, "pmf %g of a share of %g", (double)params.environment_pmf, share);
    for (uint32_t i = 0; i < NUMBERS; i++) r[i] = (i << 16) + 0x8000;
    if (!KERNEL_CALL(&cl, program, "shares", NUMBERS / LANES_TRIED, SCALAR(numbers), IN(&params, 1), IN(r, NUMBERS), OUT(stretched, NUMBERS))) return;
    for (uint32_t i = 0; i < NUMBERS; i++) {
        const double at = r[i] * 0x1p-32, to = at < share ? 0.5 * at / share : 0.5 + 0.5 * (at - share) / (1 - share);
        wrong += fabs(stretched[i] * 0x1p-32 - to) > 0x1p-30 || (share == 0.5 && stretched[i] != r[i]);
    }
    CHECK_MSG(!wrong, "%u of %u numbers go to the wrong place where lights at infinity have %g of them", wrong, NUMBERS, share);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    program = kernel_build(&cl, "choice", LANES_TRIED, "");
    static const uint64_t shares[] = {1, 2, 3, 1000003, UINT64_C(1) << 31, (UINT64_C(1) << 31) + 1, (UINT64_C(1) << 32) - 1, UINT64_C(1) << 32};
    for (uint32_t i = 0; program && i < sizeof shares / sizeof *shares; i++) check_stretch(shares[i]);
    if (program) {
        check_chain((const float[]){0.5f}, 1);
        check_chain((const float[]){0.04f, 0.3f, 0.9f}, 3);
        check_chain((const float[]){0.0f, 0.001f, 1.0f / 3, 0.25f, 1.0f}, 5);
        check_fill();
        check_share(0.5);
        check_share(0.125);
        check_share(0.875);
        clReleaseProgram(program);
    }
    ec_cl_close(&cl);
    TEST_END();
}
