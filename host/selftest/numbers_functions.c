/* The renderer's own functions of numbers, against double. */
#include <math.h>
#include <stdio.h>

#include "selftest/numbers_run.h"

static const double u = 0x1p-24, pi = 3.14159265358979323846;

typedef struct function {
    const char *name;
    int function;
    double tolerance; /* of 1 + |value| where it is absolute, else of the value */
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

/* The errors that kernels/lib/elementary.h states for its polynomials; of turns, 2.5e-8 of an eighth and three roundings. */
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

/* The weights of two strategies add up to 1, each rounded three times, whatever their densities; 0 and infinity on one side. */
ec_result ec_selftest_mis_weights(ec_selftest *t, ec_error *err)
{
    enum { DECADES = 61 };
    ec_numbers_run run;
    EC_TRY(ec_numbers_open(t, &run, err));
    double worst = 0;
    uint64_t wrong = 0;
    uint64_t random = 17;
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) {
        double decade[2] = {i % DECADES - 30.0, i / DECADES % DECADES - 30.0};
        run.a[i] = (float)(pow(10, decade[0]) * ec_random_between(&random, 1, 2));
        run.b[i] = (float)(pow(10, decade[1]) * ec_random_between(&random, 1, 2));
        if (i % 16 == 15) run.a[i] = i / 16 % 2 ? INFINITY : 0; /* a density that is not there, a single direction's */
    }
    ec_result result = ec_numbers_go(t, &run, EC_NUMBERS_MIS, err);
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) {
        float swap = run.a[i];
        run.c[i] = run.out[i]; /* not an argument of the function */
        run.a[i] = run.b[i];
        run.b[i] = swap;
    }
    if (result == EC_OK) result = ec_numbers_go(t, &run, EC_NUMBERS_MIS, err);
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) {
        double off = fabs((double)run.c[i] + (double)run.out[i] - 1), expected = run.b[i] == 0 ? 0 : 1;
        wrong += !(run.c[i] >= 0 && run.c[i] <= 1 && run.out[i] >= 0 && run.out[i] <= 1);
        if (i % 16 == 15) wrong += (double)run.c[i] != expected || (double)run.out[i] != 1 - expected;
        if (!(off <= worst)) worst = off;
    }
    if (result == EC_OK) result = ec_selftest_largest(t, "w(a, b) + w(b, a) - 1", worst, 4 * u, NULL, err);
    if (result == EC_OK) result = ec_selftest_none(t, "outside of 0 to 1", wrong, EC_NUMBERS_N, NULL, err);
    ec_numbers_close(&run);
    return result;
}

/* A path goes on where a number k 2^-24 is below q, so with probability ceil(q 2^24) 2^-24, and is divided by q: they have to be equal.
 * What goes on may weigh no more than before, or than 1 / 0.95 of it. */
ec_result ec_selftest_survival(ec_selftest *t, ec_error *err)
{
    ec_numbers_run run;
    uint64_t random = 19;
    double bias = 0, weight = 0;
    EC_TRY(ec_numbers_open(t, &run, err));
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++)
        run.a[i] = i % 16 == 0 ? ec_float_of_bits(1 + i) : (float)pow(10, ec_random_between(&random, i % 2 ? -38 : -4, 3));
    ec_result result = ec_numbers_go(t, &run, EC_NUMBERS_SURVIVAL, err);
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) {
        double q = (double)run.out[i], played = fmin(ceil(q * 0x1p24) * u, 1);
        double off = fabs(played / q - 1), grown = (double)run.a[i] / q / fmax((double)run.a[i] / 0.95, 1);
        if (!(off <= bias)) bias = off;
        if (!(grown <= weight)) weight = grown;
    }
    if (result == EC_OK) result = ec_selftest_largest(t, "played against divided by", bias, u, NULL, err);
    if (result == EC_OK) result = ec_selftest_largest(t, "weight over its bound", fmax(weight - 1, 0), 2 * u, NULL, err);
    ec_numbers_close(&run);
    return result;
}
