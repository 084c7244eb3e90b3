/* tier: full */
/* Reflectance of a thin film on a surface, where the answer is known without a film. */
#include "robust/cases.h"
#include "robust/scatter.h"

/* Cosines, half of them at grazing angles. */
static double cosine_of(uint32_t i)
{
    double all = (i + 0.5) / EC_SCATTER_N;
    return i % 2 ? pow(10, -7 * all) : all;
}

static void put_film(ec_scatter_run *run, uint32_t i, double ior, double nanometres, double cosine, double eta, double f0)
{
    ec_scatter_put3(run, EC_SCATTER_W, i, ior, nanometres, cosine);
    ec_scatter_put(run, EC_SCATTER_ETA, i, eta);
    ec_scatter_put(run, EC_SCATTER_F0, i, f0);
}

/* A film of no thickness, or with the index of air, has no effect: Schlick's formula remains, and Fresnel's on glass. The index is computed
 * from f0, and f0 from that again: ten roundings, and as many in the formula. */
static ec_result nothing(ec_selftest *t, ec_scatter_run *run, ec_error *err)
{
    static const double indices[] = {1.5, 2.4, 1.01};
    ec_worst worst = {0};
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double eta = i % 4 < 3 ? indices[i % 4] : 1, r = (eta - 1) / (eta + 1);
        put_film(run, i, i % 8 < 4 ? 1.6 : 1, i % 8 < 4 ? 0 : 400, cosine_of(i), eta, eta == 1 ? (i / 8 + 0.5) * 8 / EC_SCATTER_N * 0.999 : r * r);
    }
    EC_TRY(ec_scatter_films(t, run, err));
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double eta = ec_scatter_given(run, EC_SCATTER_ETA, i), f0 = ec_scatter_given(run, EC_SCATTER_F0, i),
               cosine = ec_scatter_given(run, EC_SCATTER_W + 2, i);
        double exact = eta == 1 ? f0 + (1 - f0) * pow(1 - cosine, 5) : ec_exact_fresnel(cosine, eta);
        for (int k = 0; k < 3; k++)
            ec_worst_take(&worst, fabs(ec_scatter_got(run, EC_SCATTER_F + k, i) - exact),
                          "index %.4g, f0 %.4g, cosine %.4g", eta, f0, cosine);
    }
    return ec_selftest_largest(t, "of nothing", worst.value, 20 * EC_U, worst.note, err);
}

/* On glass, reflectance from inside equals that along the same way from outside, and beyond the critical angle all light is reflected. An
 * error of u in a cosine c outside is one of u / c where that cosine is recovered; it moves the phase by some tens of u / c. */
static ec_result inside(ec_selftest *t, ec_scatter_run *run, ec_error *err)
{
    enum { HALF = EC_SCATTER_N / 2 };
    ec_worst worst = {0};
    uint64_t wrong = 0, total = 0;
    for (uint32_t i = 0; i < HALF; i++) {
        double eta = i % 2 ? 1.5 : 2.4, f0 = pow((eta - 1) / (eta + 1), 2), ior = 1.2 + i % 7 * 0.2,
               thickness = 50 + i % 11 * 60, outside = 0.05 + 0.95 * (i + 0.5) / HALF;
        put_film(run, i, ior, thickness, outside, eta, f0);
        put_film(run, HALF + i, ior, thickness, sqrt(1 - (1 - outside * outside) / (eta * eta)), 1 / eta, f0);
    }
    EC_TRY(ec_scatter_films(t, run, err));
    for (uint32_t i = 0; i < HALF; i++)
        for (int k = 0; k < 3; k++)
            ec_worst_take(&worst,
                          fabs(ec_scatter_got(run, EC_SCATTER_F + k, i) -
                               ec_scatter_got(run, EC_SCATTER_F + k, HALF + i)),
                          "cosine %.3g", ec_scatter_given(run, EC_SCATTER_W + 2, i));
    EC_TRY(ec_selftest_largest(t, "from inside glass and outside", worst.value, 50 * EC_U / 0.05, worst.note, err));
    for (uint32_t i = 0; i < EC_SCATTER_N; i++)
        put_film(run, i, 1 + i % 9 * 0.2, i % 11 * 60, sqrt(1 - 1 / (1.5 * 1.5)) * (i + 0.5) / EC_SCATTER_N - 1e-6, 1 / 1.5, 0.04);
    EC_TRY(ec_scatter_films(t, run, err));
    for (uint32_t i = 0; i < EC_SCATTER_N; i++)
        for (int k = 0; k < 3; k++) wrong += !(ec_scatter_got(run, EC_SCATTER_F + k, i) == 1), total++;
    return ec_selftest_none(t, "light out beyond the critical angle", wrong, total, NULL, err);
}

/* The reflectance is between 0 and 1 for films of no thickness to millimetres, of indices up to a thousand, over surfaces that reflect
 * nothing or everything. Along the surface it is 1: the outer face transmits T = 2 c (1 + n^2) / sqrt(n^2 - 1) < 1e-6. */
static ec_result shares(ec_selftest *t, ec_scatter_run *run, ec_error *err)
{
    uint64_t random = 11, wrong = 0;
    ec_worst missing = {0};
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double thickness = i % 8 ? pow(10, ec_random_between(&random, i % 2 ? 0 : -3, 6)) : 0, ior = i % 4 ? 1.1 + ec_random_unit(&random) : pow(10, 3 * ec_random_unit(&random));
        put_film(run, i, ior, thickness, i % 2 ? 1e-7 : ec_random_unit(&random), 1, i % 16 < 2 ? 0 : i % 16 < 4 ? 1 : ec_random_unit(&random));
    }
    EC_TRY(ec_scatter_films(t, run, err));
    for (uint32_t i = 0; i < EC_SCATTER_N; i++)
        for (int k = 0; k < 3; k++) {
            double got = ec_scatter_got(run, EC_SCATTER_F + k, i);
            wrong += !(got >= 0 && got <= 1);
            if (i % 2)
                ec_worst_take(&missing, 1 - got, "index %.4g, %.4g nm", ec_scatter_given(run, EC_SCATTER_W, i),
                              ec_scatter_given(run, EC_SCATTER_W + 1, i));
        }
    EC_TRY(ec_selftest_none(t, "less than none or more than all", wrong, 3 * EC_SCATTER_N, NULL, err));
    /* The series adds at most 2 T twice, times the sum of a row of the matrix to Rec. 709, 5.3: 22 T in all. */
    return ec_selftest_largest(t, "missing along the surface", missing.value, 22e-6, missing.note, err);
}

static ec_result film_case(ec_selftest *t, ec_error *err)
{
    ec_scatter_run run;
    EC_TRY(ec_scatter_open(t, &run, err));
    ec_result result = nothing(t, &run, err);
    if (result == EC_OK) result = inside(t, &run, err);
    if (result == EC_OK) result = shares(t, &run, err);
    ec_scatter_close(&run);
    return result;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"scatter/film", false, film_case, "rainbows on films of nothing; black or bright rims"},
    };
    return RUN_CASES(cases);
}
