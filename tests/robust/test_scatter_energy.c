/* tier: full */
/* Light that a surface returns: no more than arrives where the model promises that, and the expected amount where glTF's model does not. */
#include <stdio.h>

#include "robust/cases.h"
#include "robust/scatter.h"

static double unit24(uint64_t *random) { return (double)(ec_random_bits(random) >> 40) * EC_U; }

/* Grey metal, glass and panes: no sample carries more than arrives, F / F G2 / G1. So no albedo exceeds 1. */
static ec_result no_gain(ec_selftest *t, ec_scatter_run *run, ec_error *err)
{
    ec_worst worst = {0};
    uint64_t random = 3;
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double alpha = pow(10, ec_random_between(&random, -4, 0)), eta = ec_random_between(&random, 1, 3);
        ec_scatter_material m = i % 3 == 0 ? ec_scatter_metal(alpha) : ec_scatter_glass(alpha, i % 3 == 1 ? 1 : i % 2 ? eta : 1 / eta);
        m.smooth = m.eta != 1 && alpha * fabs(m.eta - 1) < 1e-4;
        ec_scatter_set(run, i, &m);
        double cosine = i % 2 ? pow(10, ec_random_between(&random, -6, 0)) : ec_random_unit(&random);
        ec_scatter_put_direction(run, EC_SCATTER_WO, i, cosine, 6 * ec_random_unit(&random));
        ec_scatter_put3(run, EC_SCATTER_W, i, unit24(&random), unit24(&random), unit24(&random));
    }
    EC_TRY(ec_scatter_go(t, run, err));
    for (uint32_t i = 0; i < EC_SCATTER_N; i++)
        if (ec_scatter_got(run, EC_SCATTER_WI_PDF, i) != 0)
            ec_worst_take(&worst, ec_scatter_got(run, EC_SCATTER_WEIGHT, i) - 1, "alpha %.3g, index %.4g, cosine %.3g",
                          ec_scatter_given(run, EC_SCATTER_ALPHA, i), ec_scatter_given(run, EC_SCATTER_ETA, i),
                          ec_scatter_given(run, EC_SCATTER_WO + 2, i));
    return ec_selftest_largest(t, "light gained by a sample", worst.value, 1e-3, worst.note, err);
}

/* f |cos| in double, for wo in the plane y = 0 with this cosine. */
typedef double exact_bsdf(const double wo[3], const double wi[3], double half_cosine);

static double albedo_of(exact_bsdf *f, double cosine)
{
    enum { BANDS = 512, SECTORS = 256 };
    double sum = 0, wo[3] = {sqrt(1 - cosine * cosine), 0, cosine};
    for (int i = 0; i < BANDS * SECTORS; i++) {
        double z = (i / SECTORS + 0.5) / BANDS, phi = EC_PI_DOUBLE * (i % SECTORS + 0.5) / SECTORS, r = sqrt(1 - z * z);
        double wi[3] = {r * cos(phi), r * sin(phi), z}, half = sqrt((1 + wo[0] * wi[0] + wo[2] * wi[2]) / 2);
        sum += f(wo, wi, half) * 2 * EC_PI_DOUBLE / BANDS / SECTORS;
    }
    return sum;
}

/* The mean weight of samples, and its standard error. */
static ec_result mean_weight(ec_selftest *t, ec_scatter_run *run, const ec_scatter_material *m, double cosine,
                             double *mean, double *noise, ec_error *err)
{
    uint64_t random = 5;
    double sum = 0, squares = 0, n = EC_SCATTER_N;
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        ec_scatter_set(run, i, m);
        ec_scatter_put_direction(run, EC_SCATTER_WO, i, cosine, 0);
        ec_scatter_put3(run, EC_SCATTER_W, i, unit24(&random), unit24(&random), unit24(&random));
    }
    EC_TRY(ec_scatter_go(t, run, err));
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double w = ec_scatter_got(run, EC_SCATTER_WI_PDF, i) != 0 ? ec_scatter_got(run, EC_SCATTER_WEIGHT, i) : 0;
        sum += w;
        squares += w * w;
    }
    *mean = sum / n;
    *noise = sqrt(fmax(squares / n - *mean * *mean, 0) / n);
    return EC_OK;
}

static ec_result albedo_row(ec_selftest *t, ec_scatter_run *run, const char *what, const ec_scatter_material *m,
                            double cosine, double expected, ec_error *err)
{
    double mean, noise;
    EC_TRY(mean_weight(t, run, m, cosine, &mean, &noise, err));
    return ec_selftest_value(t, what, expected, mean, noise, 4 * noise + 1e-4, err);
}

/* All white light is kept except at most 1 %, and none is added. */
static ec_result kept_row(ec_selftest *t, ec_scatter_run *run, const char *what, const ec_scatter_material *m,
                          double cosine, ec_error *err)
{
    double mean, noise;
    EC_TRY(mean_weight(t, run, m, cosine, &mean, &noise, err));
    return ec_selftest_value(t, what, 1, mean, noise, (mean > 1 ? 1e-5 : 0.01) + 4 * noise, err);
}

/* glTF's coat over a white base: F D V + (1 - F) / pi, times the cosine (appendix B). */
#define COAT_ALPHA 0.3
static double coat(const double wo[3], const double wi[3], double half_cosine)
{
    double h[3] = {wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]}, fresnel = 0.04 + 0.96 * pow(1 - half_cosine, 5);
    for (int k = 0; k < 3; k++) h[k] /= 2 * half_cosine;
    double visible = 0.5 / (wi[2] * ec_exact_masking(COAT_ALPHA, wo[2]) + wo[2] * ec_exact_masking(COAT_ALPHA, wi[2]));
    return (fresnel * ec_exact_ggx(COAT_ALPHA, h) * visible + (1 - fresnel) / EC_PI_DOUBLE) * wi[2];
}

/* A white base under a coat returns more than it gets at grazing angles: glTF subtracts the coat's reflectance at the half vector's angle,
 * not at either direction's. That is its model, so the expected value includes it. Inside half-transmitting glass eclat has no such mix, or
 * light that is reflected totally again and again would grow: half of it meets the base, half the interface. */
static ec_result mixtures(ec_selftest *t, ec_scatter_run *run, ec_error *err)
{
    static const double cosines[] = {1, 0.5, 0.1};
    ec_scatter_material m = {.base = 1, .f0 = 0.04, .alpha = COAT_ALPHA, .eta = 1};
    for (int c = 0; c < 3; c++) {
        char what[48];
        snprintf(what, sizeof what, "white under a coat, cos %g", cosines[c]);
        EC_TRY(albedo_row(t, run, what, &m, cosines[c], albedo_of(coat, cosines[c]), err));
    }
    m = ec_scatter_glass(1e-4, 1 / 1.5);
    m.smooth = true;
    m.transmission = 0.5;
    return albedo_row(t, run, "half-clear glass from inside", &m, 0.5, 1, err);
}

static ec_result energy_case(ec_selftest *t, ec_error *err)
{
    ec_scatter_run run;
    EC_TRY(ec_scatter_open(t, &run, err));
    ec_result result = no_gain(t, &run, err);
    if (result == EC_OK) result = mixtures(t, &run, err);
    ec_scatter_close(&run);
    return result;
}

/* With and without multiple scattering between facets. Head-on, a perfect metal of alpha 1 keeps 1 - ln 2 with single scattering: the
 * integral of mu / (1 + mu) over mu. Glass, and all surfaces with multiple scattering, lose only what the table holds back, below 1 %. */
static ec_result furnaces(ec_selftest *t, bool multiple, ec_error *err)
{
    static const double cosines[] = {1, 0.3};
    ec_scatter_run run;
    EC_TRY(ec_scatter_open_with(t, multiple ? "+EC_FEATURE_MULTISCATTER" : "", &run, err));
    ec_scatter_material metal = ec_scatter_metal(1);
    ec_result result = EC_OK;
    if (!multiple) result = albedo_row(t, &run, "metal of roughness 1, once", &metal, 1, 1 - 0.693147180559945309, err);
    for (int i = 0; multiple && result == EC_OK && i < 8; i++) {
        char what[64];
        double roughness = i / 2 % 2 ? 0.5 : 1;
        ec_scatter_material m = i < 4 ? ec_scatter_metal(roughness * roughness) : ec_scatter_glass(roughness * roughness, 1.5);
        snprintf(what, sizeof what, "%s of roughness %g, cos %g, again", i < 4 ? "metal" : "glass", roughness, cosines[i % 2]);
        result = kept_row(t, &run, what, &m, cosines[i % 2], err);
    }
    ec_scatter_close(&run);
    return result;
}

static ec_result multiple_case(ec_selftest *t, ec_error *err)
{
    ec_result result = furnaces(t, false, err);
    return result == EC_OK ? furnaces(t, true, err) : result;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"scatter/energy", false, energy_case, "materials that glow"},
        {"scatter/multiple", false, multiple_case, "rough metal and glass that darken, or glow"},
    };
    return RUN_CASES(cases);
}
