/* tier: full */
/* The microfacet distribution, its masking and its sampling, down to the limit of smooth surfaces and to grazing angles. */
#include "robust/cases.h"
#include "robust/scatter.h"

static const double alphas[] = {1, 0.1, 1e-2, 1e-3, 1e-4}, cosines[] = {1, 0.5, 1e-2, 1e-4, 1e-6};
enum { ALPHAS = sizeof alphas / sizeof alphas[0], COSINES = sizeof cosines / sizeof cosines[0] };

/* D contains the square of x^2 / alpha^2 + z^2, with five roundings, and six more; the masking has five in all. */
static ec_result closed_forms(ec_selftest *t, ec_scatter_run *run, ec_error *err)
{
    ec_worst density = {0}, masking = {0};
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double slope = alphas[i % ALPHAS] * pow(10, 8.0 * i / EC_SCATTER_N - 3); /* of the normal: from the peak to grazing */
        ec_scatter_material m = ec_scatter_metal(alphas[i % ALPHAS]);
        ec_scatter_set(run, i, &m);
        ec_scatter_put_direction(run, EC_SCATTER_WO, i, 0.5, 0);
        double z = 1 / sqrt(1 + slope * slope);
        ec_scatter_put3(run, EC_SCATTER_W, i, slope * z * cos(i), slope * z * sin(i), z);
    }
    EC_TRY(ec_scatter_go(t, run, err));
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double alpha = ec_scatter_given(run, EC_SCATTER_ALPHA, i), h[3];
        ec_scatter_given3(run, EC_SCATTER_W, i, h);
        double d = ec_exact_ggx(alpha, h), lambda = ec_exact_masking(alpha, h[2]);
        ec_worst_take(&density, fabs(ec_scatter_got(run, EC_SCATTER_D, i) / d - 1), "alpha %g, cosine %.8g", alpha, h[2]);
        ec_worst_take(&masking, fabs(ec_scatter_got(run, EC_SCATTER_LAMBDA, i) / lambda - 1), "alpha %g, cosine %.8g", alpha, h[2]);
    }
    EC_TRY(ec_selftest_largest(t, "D", density.value, 16 * EC_U, density.note, err));
    return ec_selftest_largest(t, "masking", masking.value, 5 * EC_U, masking.note, err);
}

/* The weak white furnace test of Heitz 2014: the integral of G1 D / (4 cos) over all wi, including those below the horizon. Midpoint rule
 * over slopes alpha t with t^2 = (1 - v^2) / v^2, where D's own measure is 2 v dv dphi / (2 pi). */
static ec_result furnace(ec_selftest *t, ec_scatter_run *run, double alpha, double cosine, ec_worst *worst, ec_error *err)
{
    enum { RADII = 255, SECTORS = EC_SCATTER_N / (RADII + 1) };
    double sum = 0, sine = sqrt((1 - cosine) * (1 + cosine));
    ec_scatter_material m = ec_scatter_metal(alpha);
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double v = (i / SECTORS + 0.5) / RADII, slope = alpha * sqrt(1 - v * v) / v,
               phi = (i % SECTORS + 0.5) / SECTORS * 2 * EC_PI_DOUBLE;
        double z = 1 / sqrt(1 + slope * slope);
        ec_scatter_set(run, i, &m);
        ec_scatter_put_direction(run, EC_SCATTER_WO, i, cosine, 0);
        if (i < RADII * SECTORS) ec_scatter_put3(run, EC_SCATTER_W, i, slope * z * cos(phi), slope * z * sin(phi), z);
        else ec_scatter_put3(run, EC_SCATTER_W, i, 0, 0, cosine); /* for the masking */
    }
    EC_TRY(ec_scatter_go(t, run, err));
    double masking = ec_scatter_got(run, EC_SCATTER_LAMBDA, RADII * SECTORS);
    for (uint32_t i = 0; i < RADII * SECTORS; i++) {
        double v = (i / SECTORS + 0.5) / RADII, h[3];
        ec_scatter_given3(run, EC_SCATTER_W, i, h);
        double facing = fmax(sine * h[0] + cosine * h[2], 0) / h[2];
        double of_exact = ec_scatter_got(run, EC_SCATTER_D, i) / ec_exact_ggx((double)(float)alpha, h);
        sum += 2 * v / RADII / SECTORS * facing * 2 / (cosine + masking) * of_exact;
    }
    ec_worst_take(worst, fabs(sum - 1), "alpha %g, cosine %g", alpha, cosine);
    return EC_OK;
}

/* Sampled directions are unit vectors to sixteen roundings (2 (wo m) m - wo; m's square has five), for all random numbers, including the
 * ends of [0, 1). Directions below the horizon are rejected. The density is that of Heitz 2018: D of a half vector whose components have
 * four roundings each. */
static ec_result samples(ec_selftest *t, ec_scatter_run *run, double alpha, double cosine, ec_worst *density,
                         uint64_t *bad, ec_error *err)
{
    uint64_t random = (uint64_t)(1 / alpha);
    ec_scatter_material m = ec_scatter_metal(alpha);
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double u[2] = {ec_random_unit(&random), ec_random_unit(&random)};
        for (int k = 0; k < 2; k++)
            if (i < 1024 && (i >> k & 1)) u[k] = i >> (2 + k) & 1 ? 1 - EC_U : 0;
        ec_scatter_set(run, i, &m);
        ec_scatter_put_direction(run, EC_SCATTER_WO, i, cosine, 0.7);
        ec_scatter_put3(run, EC_SCATTER_W, i, fmin(u[0], 1 - EC_U), fmin(u[1], 1 - EC_U), 0.5);
    }
    EC_TRY(ec_scatter_go(t, run, err));
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double wo[3], wi[3], pdf = ec_scatter_got(run, EC_SCATTER_WI_PDF, i);
        ec_scatter_given3(run, EC_SCATTER_WO, i, wo);
        ec_scatter_got3(run, EC_SCATTER_WI, i, wi);
        double weight = ec_scatter_got(run, EC_SCATTER_WEIGHT, i);
        bool above = wi[2] > 0, unit = fabs(wi[0] * wi[0] + wi[1] * wi[1] + wi[2] * wi[2] - 1) <= 32 * EC_U;
        *bad += above ? !unit || !(pdf > 0) || !isfinite(pdf) || !(weight >= 0 && weight <= 1 + 16 * EC_U) : pdf != 0;
        double off = above ? fabs(pdf / ec_exact_visible((double)(float)alpha, wo, wi) - 1) : 0;
        ec_worst_take(density, off, "alpha %g, wo.z %g, wi.z %.6g", alpha, cosine, wi[2]);
    }
    return EC_OK;
}

static ec_result ggx_case(ec_selftest *t, ec_error *err)
{
    ec_scatter_run run;
    EC_TRY(ec_scatter_open(t, &run, err));
    ec_worst energy = {0}, density = {0};
    uint64_t bad = 0;
    ec_result result = closed_forms(t, &run, err);
    for (int i = 0; i < ALPHAS * COSINES && result == EC_OK; i++) {
        result = furnace(t, &run, alphas[i / COSINES], cosines[i % COSINES], &energy, err);
        if (result == EC_OK) result = samples(t, &run, alphas[i / COSINES], cosines[i % COSINES], &density, &bad, err);
    }
    if (result == EC_OK) result = ec_selftest_largest(t, "weak furnace", energy.value, 1e-3, energy.note, err);
    if (result == EC_OK) result = ec_selftest_largest(t, "density of samples", density.value, 36 * EC_U, density.note, err);
    if (result == EC_OK)
        result = ec_selftest_none(t, "samples not unit, or astray", bad, (uint64_t)ALPHAS * COSINES * EC_SCATTER_N,
                                  NULL, err);
    ec_scatter_close(&run);
    return result;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"scatter/ggx", false, ggx_case, "narrow lobes from 1 - cos^2: no digit is left at roughness 0.01"},
    };
    return RUN_CASES(cases);
}
