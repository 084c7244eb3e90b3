/* The renderer's own numerical functions, compared with double. */
#include <math.h>
#include <stdio.h>

#include "selftest/numbers_run.h"

static const double u = 0x1p-24, pi = 3.14159265358979323846;

typedef struct function {
    const char *name;
    int function;
    double tolerance; /* relative to 1 + |value| if absolute, otherwise to the value */
    bool relative;
    void (*draw)(uint64_t *random, uint32_t i, float *a, float *b);
    double (*exact)(double a, double b);
} function;

static void draw_turn(uint64_t *random, uint32_t i, float *a, float *b)
{
    *b = 0;
    *a = i % 2 ? (float)(ec_random_bits(random) >> 40) * 0x1p-24f : fminf((float)(i / 2 % 9) / 8 + (float)(i / 32) * 0x1p-24f, 1);
}
static void draw_negative(uint64_t *random, uint32_t i, float *a, float *b)
{
    *b = 0;
    *a = i ? -(float)pow(10, ec_random_between(random, -8, 1.94)) : 0; /* to exp(-87), still a normal float */
}
static void draw_unit(uint64_t *random, uint32_t i, float *a, float *b)
{
    *a = i % 2 ? (float)((ec_random_bits(random) >> 40) + 1) * 0x1p-24f : (float)pow(10, ec_random_between(random, -37, 0));
    *b = 0;
}
static void draw_plane(uint64_t *random, uint32_t i, float *a, float *b)
{
    *a = ec_any_float(random);
    *b = i % 2 ? ec_any_float(random) : (float)((double)*a * ec_random_between(random, -3, 3));
}

static double exact_sin(double a, double b) { return (void)b, sin(2 * pi * a); }
static double exact_cos(double a, double b) { return (void)b, cos(2 * pi * a); }
static double exact_exp(double a, double b) { return (void)b, exp(a); }
static double exact_log(double a, double b) { return (void)b, log(a); }
static double exact_atan2(double a, double b) { return atan2(a, b) / (2 * pi); }

/* Tolerances are the errors that kernels/lib/elementary.h states for its polynomials; for turns, 2.5e-8 of an eighth and three roundings. */
ec_result ec_selftest_functions(ec_selftest *t, ec_error *err)
{
    const function functions[] = {
        {"sin", EC_NUMBERS_SIN, 4 * u, false, draw_turn, exact_sin},
        {"cos", EC_NUMBERS_COS, 4 * u, false, draw_turn, exact_cos},
        {"exp", EC_NUMBERS_EXP, 4 * u, true, draw_negative, exact_exp},
        {"log", EC_NUMBERS_LOG, 8 * u, true, draw_unit, exact_log},
        {"atan2", EC_NUMBERS_ATAN2, 2 * u, false, draw_plane, exact_atan2},
    };
    ec_numbers_run run;
    EC_TRY(ec_numbers_open(t, &run, err));
    ec_result result = EC_OK;
    for (int k = 0; k < 5 && result == EC_OK; k++) {
        const function *f = &functions[k];
        uint64_t random = 13;
        double worst = 0;
        char note[64] = "";
        for (uint32_t i = 0; i < EC_NUMBERS_N; i++) f->draw(&random, i, &run.a[i], &run.b[i]);
        if ((result = ec_numbers_go(t, &run, (uint32_t)f->function, err)) != EC_OK) break;
        for (uint32_t i = 0; i < EC_NUMBERS_N; i++) {
            double want = f->exact((double)run.a[i], (double)run.b[i]), off = fabs((double)run.out[i] - want);
            if (f->relative && want != 0) off /= fabs(want);
            if (off <= worst) continue;
            worst = off;
            snprintf(note, sizeof note, "of %.9g", (double)run.a[i]);
        }
        result = ec_selftest_largest(t, f->name, worst, f->tolerance, note, err);
    }
    ec_numbers_close(&run);
    return result;
}
