/* tier: full */
/* Checks that light goes both ways alike. */
#include "robust/cases.h"
#include "robust/scatter.h"

/* Cosine between wo and the microfacet that refracts it to w. */
static double facing(const ec_scatter_run *run, uint32_t i, double eta)
{
    double wo[3], wi[3], dot = 0, length2 = 0;
    ec_scatter_given3(run, EC_SCATTER_WO, i, wo);
    ec_scatter_given3(run, EC_SCATTER_W, i, wi);
    for (int k = 0; k < 3; k++) dot += wo[k] * (wo[k] + eta * wi[k]), length2 += pow(wo[k] + eta * wi[k], 2);
    return fabs(dot) / sqrt(length2);
}

/* Exchanges wo and wi, and compares f / |cos|. Between media, basic radiance is carried, whose solid angle is n^2 times as large (Nicodemus
 * 1963): f out of glass is n^2 times f into it. Not near total reflection, where the rounding of 1 / n shows in 1 - F: by 2 u over the
 * squared cosine of facing() in air. Otherwise some fifty roundings, most of them in the half vector over alpha. */
static ec_result reciprocity(ec_selftest *t, ec_scatter_run *run, bool through, ec_error *err)
{
    uint64_t random = 7;
    ec_worst worst = {0};
    uint32_t n = EC_SCATTER_N / 2;
    for (uint32_t i = 0; i < n; i++) {
        double eta = ec_random_between(&random, 1.5, 2.4), wo[3], wi[3];
        ec_scatter_material m = ec_scatter_glass(ec_random_between(&random, through ? 0.5 : 1e-3, 1), through ? eta : 1);
        if (!through) {
            m.metallic = ec_random_unit(&random);
            m.base = ec_random_unit(&random);
            m.transmission = ec_random_unit(&random);
        }
        ec_scatter_set(run, i, &m);
        ec_scatter_put_direction(run, EC_SCATTER_WO, i, ec_random_between(&random, 1e-3, 1), 6.3 * ec_random_unit(&random));
        double side = through ? -1 : 1; /* z always points to wo's side */
        ec_scatter_put_direction(run, EC_SCATTER_W, i, side * ec_random_between(&random, 1e-3, 1), 6.3 * ec_random_unit(&random));
        ec_scatter_given3(run, EC_SCATTER_WO, i, wo);
        ec_scatter_given3(run, EC_SCATTER_W, i, wi);
        if (through) m.eta = 1 / ec_scatter_given(run, EC_SCATTER_ETA, i);
        ec_scatter_set(run, i + n, &m);
        ec_scatter_put3(run, EC_SCATTER_WO, i + n, wi[0], wi[1], side * wi[2]);
        ec_scatter_put3(run, EC_SCATTER_W, i + n, wo[0], wo[1], side * wo[2]);
    }
    EC_TRY(ec_scatter_go(t, run, err));
    for (uint32_t i = 0; i < n; i++) {
        double eta = through ? ec_scatter_given(run, EC_SCATTER_ETA, i) : 1;
        double there = ec_scatter_got(run, EC_SCATTER_F, i) / fabs(ec_scatter_given(run, EC_SCATTER_W + 2, i));
        double back = ec_scatter_got(run, EC_SCATTER_F, i + n) / fabs(ec_scatter_given(run, EC_SCATTER_W + 2, i + n)) * eta * eta;
        if ((there != 0 || back != 0) && (!through || facing(run, i, eta) > 0.2))
            ec_worst_take(&worst, fabs(there - back) / fmax(there, back), "alpha %.3g, index %.4g: %.8g and %.8g",
                          ec_scatter_given(run, EC_SCATTER_ALPHA, i), eta, there, back);
    }
    return ec_selftest_largest(t, through ? "through glass" : "reflected", worst.value, 1e-5, worst.note, err);
}

static ec_result reciprocity_case(ec_selftest *t, ec_error *err)
{
    ec_scatter_run run;
    EC_TRY(ec_scatter_open(t, &run, err));
    ec_result result = reciprocity(t, &run, false, err);
    if (result == EC_OK) result = reciprocity(t, &run, true, err);
    ec_scatter_close(&run);
    return result;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"scatter/reciprocity", false, reciprocity_case, "a picture that depends on the side paths start from"},
    };
    return RUN_CASES(cases);
}
