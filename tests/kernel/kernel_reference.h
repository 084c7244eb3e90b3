/* Shared by the tests against double precision: N values an array, every lane width, equal bits from all of them. */
#ifndef EC_TESTS_KERNEL_REFERENCE_H
#define EC_TESTS_KERNEL_REFERENCE_H

#include "kernel/kernel_run.h"

#define N 8192u /* values a test; a multiple of 16 */
#define U 0x1p-24

static ec_cl cl;
static cl_program programs[LANE_WIDTHS];

static inline float random_float(double a, double b) { return (float)test_random_in(a, b); }

/* Runs a kernel at every width and compares the arrays in [first, count) with those of LANES 1, which are the result. */
static inline bool run_all(const char *name, kernel_array *arrays, uint32_t count, uint32_t first)
{
    int before = test_failures;
    void *one[KERNEL_ARRAYS] = {NULL};
    for (int i = 0; i < kernel_widths(&cl); i++) {
        if (!kernel_call(&cl, programs[i], name, N / (uint32_t)lane_widths[i], 64, arrays, count)) break;
        for (uint32_t k = first; k < count; k++) {
            if (i == 0) memcpy(one[k] = malloc(arrays[k].bytes), arrays[k].data, arrays[k].bytes);
            else CHECK_MSG(memcmp(one[k], arrays[k].data, arrays[k].bytes) == 0, "%s: LANES %d gives other bits than 1", name, lane_widths[i]);
        }
    }
    for (uint32_t k = first; k < count; k++) {
        if (one[k]) memcpy(arrays[k].data, one[k], arrays[k].bytes);
        free(one[k]);
    }
    return test_failures == before;
}
#define RUN_ALL(name, first, ...)                                                                  \
    run_all(name, (kernel_array[]){__VA_ARGS__}, sizeof((kernel_array[]){__VA_ARGS__}) / sizeof(kernel_array), first)

static const double pi = 3.14159265358979323846;

static uint32_t n = N;

static inline double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

#endif
