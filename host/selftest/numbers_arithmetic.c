/* Properties of a device's float arithmetic on which the renderer relies. */
#include <math.h>

#include "selftest/numbers_run.h"

static const double u = 0x1p-24;

/* Returns the error in ulps of the exact value. */
static double ulps_off(float got, double exact)
{
    int exponent;
    frexp(exact, &exponent);
    return exact == 0 ? (got == 0 ? 0 : INFINITY) : fabs((double)got - exact) / ldexp(1, exponent - 24);
}

/* Operations are rounded once if the device says so: half an ulp, from which double differs by 2^-29 of one; otherwise OpenCL 1.2 allows 2.5 and 3
 * ulps. Sum and fma are rounded once on every device; a b - c must be rounded twice, or edges of triangles do not meet. */
ec_result ec_selftest_arithmetic(ec_selftest *t, ec_error *err)
{
    bool exact = t->cl->info.correctly_rounded_divide_sqrt;
    const struct {
        const char *name;
        int function;
        double most;
    } rows[] = {{"a / b", EC_NUMBERS_DIVIDE, exact ? 0.5 : 2.5}, {"sqrt", EC_NUMBERS_SQRT, exact ? 0.5 : 3}, {"a + b", EC_NUMBERS_ADD, 0.5},
                {"fma", EC_NUMBERS_FMA, 0.5}, {"a b - c, not contracted", EC_NUMBERS_LESS, 0.5}};
    ec_numbers_run run;
    uint64_t random = 11;
    EC_TRY(ec_numbers_open(t, &run, err));
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) {
        run.a[i] = fabsf(ec_any_float(&random));
        run.b[i] = ec_any_float(&random);
        run.c[i] = run.a[i] * run.b[i]; /* rounded: fma then gives what rounding took from the product */
    }
    ec_result result = EC_OK;
    for (int r = 0; r < 5 && result == EC_OK; r++) {
        double worst = 0;
        if ((result = ec_numbers_go(t, &run, (uint32_t)rows[r].function, err)) != EC_OK) break;
        for (uint32_t i = 0; i < EC_NUMBERS_N; i++) {
            double a = (double)run.a[i], b = (double)run.b[i], c = (double)run.c[i];
            double want = r == 0 ? a / b : r == 1 ? sqrt(a) : r == 2 ? a + b : r == 3 ? a * b - c : 0;
            double off = ulps_off(run.out[i], want);
            if (!(off <= worst)) worst = off;
        }
        /* the error in ulps, expressed as that of a value near 1 */
        result = ec_selftest_largest(t, rows[r].name, worst * 2 * u, (rows[r].most + 1e-6) * 2 * u, NULL, err);
    }
    ec_numbers_close(&run);
    return result;
}

/* NaN and infinity are recognised by their bits, and only != holds with NaN: a compiler that assumes finite values drops both tests. Denormals may
 * count as zero, and as nothing else. */
ec_result ec_selftest_not_finite(ec_selftest *t, ec_error *err)
{
    static const uint32_t bits[] = {0x7f800000, 0xff800000, 0x7fc00000, 0xffc00000, 0x7f800001, 0xff800001, 0x7fffffff, 0xffffffff,
                                    0x00000000, 0x80000000, 0x00000001, 0x807fffff, 0x00800000, 0x7f7fffff, 0xff7fffff, 0x3f800000};
    enum { KINDS = sizeof bits / sizeof bits[0], NOT_FINITE = 8, NANS = 6 };
    ec_numbers_run run;
    uint64_t seen = 0, compared = 0, denormal = 0;
    EC_TRY(ec_numbers_open(t, &run, err));
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) {
        run.a[i] = ec_float_of_bits(bits[i % KINDS]);
        run.b[i] = ec_float_of_bits(bits[i / KINDS % KINDS]);
    }
    ec_result result = ec_numbers_go(t, &run, EC_NUMBERS_IS_FINITE, err);
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) seen += run.out[i] != (i % KINDS < NOT_FINITE ? 0 : 1);
    if (result == EC_OK) result = ec_numbers_go(t, &run, EC_NUMBERS_COMPARED, err);
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) {
        float a = run.a[i], b = run.b[i];
        bool tiny = fabsf(a) < 0x1p-126f || fabsf(b) < 0x1p-126f;
        float want = (a < b ? 1 : 0) + (a > b ? 2 : 0) + (a == b ? 4 : 0) + (a != b ? 8 : 0);
        compared += !tiny && run.out[i] != want;
    }
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) run.a[i] = ec_float_of_bits(1 + i * 256), run.b[i] = 0;
    if (result == EC_OK) result = ec_numbers_go(t, &run, EC_NUMBERS_ADD, err);
    for (uint32_t i = 0; i < EC_NUMBERS_N; i++) denormal += run.out[i] != run.a[i] && run.out[i] != 0;
    if (result == EC_OK) result = ec_selftest_none(t, "taken for finite, or not", seen, EC_NUMBERS_N, NULL, err);
    if (result == EC_OK) result = ec_selftest_none(t, "compared wrongly", compared, EC_NUMBERS_N, NULL, err);
    if (result == EC_OK) result = ec_selftest_none(t, "denormal neither kept nor zero", denormal, EC_NUMBERS_N, NULL, err);
    ec_numbers_close(&run);
    return result;
}
