#include "selftest/numbers_run.h"

#include <stdio.h>
#include <stdlib.h>

#include "shared/features.h"

ec_result ec_numbers_open(ec_selftest *t, ec_numbers_run *run, ec_error *err)
{
    char options[64];
    float *all = calloc(4 * EC_NUMBERS_N, sizeof *all);
    *run = (ec_numbers_run){.a = all};
    if (!all) return ec_fail(err, "out of memory for numbers");
    run->b = all + EC_NUMBERS_N;
    run->c = all + 2 * EC_NUMBERS_N;
    run->out = all + 3 * EC_NUMBERS_N;
    snprintf(options, sizeof options, "-DLANES=%u -DFEATURES=EC_FEATURE_SOBOL", t->lanes);
    ec_result result = ec_program_build(t->cl, "numbers", ec_kernel_source("numbers"), options, &run->program, err);
    if (result != EC_OK) ec_numbers_close(run);
    return result;
}

void ec_numbers_close(ec_numbers_run *run)
{
    if (run->program) clReleaseProgram(run->program);
    free(run->a);
    *run = (ec_numbers_run){0};
}

ec_result ec_numbers_go(ec_selftest *t, ec_numbers_run *run, uint32_t function, ec_error *err)
{
    uint32_t n = EC_NUMBERS_N;
    const ec_array arrays[] = {EC_SCALAR(n),     EC_SCALAR(function), EC_IN(run->a, n),
                               EC_IN(run->b, n), EC_IN(run->c, n),    EC_OUT(run->out, n)};
    return ec_kernel_call(t->cl, run->program, "ec_numbers", n / t->lanes, 64, arrays, 6, err);
}

ec_result ec_numbers_random(ec_selftest *t, ec_numbers_run *run, uint32_t seed, const uint32_t *pixel,
                            const uint32_t *index, uint32_t pair, uint32_t *pairs, ec_error *err)
{
    uint32_t n = EC_NUMBERS_N;
    const ec_array arrays[] = {EC_SCALAR(n),    EC_SCALAR(seed), EC_IN(pixel, n),
                               EC_IN(index, n), EC_SCALAR(pair), EC_OUT(pairs, 2 * n)};
    return ec_kernel_call(t->cl, run->program, "ec_random", n / t->lanes, 64, arrays, 6, err);
}
