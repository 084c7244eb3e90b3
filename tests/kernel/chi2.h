/* Compares samples with the density that they should have, by chi-square. Cells that expect fewer than 5 are pooled; significance is 0.01
 * over all tests of test_chi2_*.c (Sidak). */
#ifndef EC_TESTS_KERNEL_CHI2_H
#define EC_TESTS_KERNEL_CHI2_H

#include "kernel/kernel_run.h"

#define SAMPLES (1u << 17)
#define TESTS 190 /* at least the number of those tests */

static ec_cl cl;
static const double pi = 3.14159265358979323846;
static float out[5 * SAMPLES];
static uint32_t samples = SAMPLES, seed = 1;
static int tests;

/* Upper tail of chi-square by Wilson and Hilferty 1931: precise to a few per cent of p for the k here. */
static inline double chi2_p(double chi2, double k)
{
    double z = (cbrt(chi2 / k) - (1 - 2 / (9 * k))) / sqrt(2 / (9 * k));
    return 0.5 * erfc(z / sqrt(2));
}

static inline void check_chi2(const char *name, const double *expected, const uint32_t *count, uint32_t cells)
{
    double chi2 = 0, pooled = 0, pooled_count = 0;
    uint32_t k = 0;
    for (uint32_t i = 0; i < cells; i++) {
        if (expected[i] >= 5) {
            chi2 += (count[i] - expected[i]) * (count[i] - expected[i]) / expected[i];
            k++;
        } else {
            pooled += expected[i];
            pooled_count += count[i];
        }
    }
    if (pooled >= 5) chi2 += (pooled_count - pooled) * (pooled_count - pooled) / pooled, k++;
    else CHECK_MSG(pooled_count <= 25, "%s: %g samples where %g are expected", name, pooled_count, pooled);
    double p = k > 1 ? chi2_p(chi2, k - 1) : 1, least = 1 - pow(0.99, 1.0 / TESTS);
    CHECK_MSG(p > least && k > 1, "%s: chi^2 %.1f with %u degrees of freedom, p = %.2g < %.2g", name, chi2, k - 1, p, least);
    tests++;
}

static inline void chi2_build(cl_program *programs, const char *features)
{
    for (int i = 0; i < kernel_widths(&cl); i++) programs[i] = kernel_build(&cl, "chi2", lane_widths[i], features);
}

static inline void chi2_release(cl_program *programs)
{
    for (int i = 0; i < LANE_WIDTHS; i++)
        if (programs[i]) clReleaseProgram(programs[i]);
}

#endif
