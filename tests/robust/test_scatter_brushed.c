/* tier: full */
/* Stretched lobes (KHR_materials_anisotropy): as wide as possible along x and nearly smooth across, of metal and of glass. */
#include "robust/cases.h"
#include "robust/scatter.h"

static double unit24(uint64_t *random) { return (double)(ec_random_bits(random) >> 40) * EC_U; }

/* The widths as floats. */
static void widths(const ec_scatter_run *run, uint32_t i, double *along, double *across)
{
    *across = ec_scatter_given(run, EC_SCATTER_ALPHA, i);
    *along = *across * ec_scatter_given(run, EC_SCATTER_STRETCH, i);
}

/* GGX with two widths (Burley 2012; Heitz 2014, eq. 85), and its masking cos sqrt(1 + slope^2). */
static double exact_ggx(double along, double across, const double h[3])
{
    double x = h[0] / along, y = h[1] / across, k = x * x + y * y + h[2] * h[2];
    return 1 / (EC_PI_DOUBLE * along * across * k * k);
}
static double exact_masking(double along, double across, const double w[3])
{
    return sqrt(pow(along * w[0], 2) + pow(across * w[1], 2) + w[2] * w[2]);
}

static void draw_widths(uint64_t *random, ec_scatter_material *m)
{
    m->alpha = ec_random_unit(random) < 0.25 ? 1e-4 : pow(10, ec_random_between(random, -4, 0));
    m->along = ec_random_unit(random) < 0.25 ? 1 : m->alpha * pow(10, -log10(m->alpha) * ec_random_unit(random));
}

/* Tolerances of scatter/ggx, with two more roundings for each squared stretch. */
static ec_result closed_forms(ec_selftest *t, ec_scatter_run *run, ec_error *err)
{
    ec_worst density = {0}, masking = {0};
    uint64_t random = 21;
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        ec_scatter_material m = ec_scatter_metal(1);
        draw_widths(&random, &m);
        double slope = pow(10, ec_random_between(&random, -3, 3)), angle = 6.3 * ec_random_unit(&random);
        double x = m.along * slope * cos(angle), y = m.alpha * slope * sin(angle), z = 1 / sqrt(1 + x * x + y * y);
        ec_scatter_set(run, i, &m);
        ec_scatter_put_direction(run, EC_SCATTER_WO, i, 0.5, 0);
        ec_scatter_put3(run, EC_SCATTER_W, i, x * z, y * z, z);
    }
    EC_TRY(ec_scatter_go(t, run, err));
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double h[3], along, across;
        widths(run, i, &along, &across);
        ec_scatter_given3(run, EC_SCATTER_W, i, h);
        double d = exact_ggx(along, across, h), lambda = exact_masking(along, across, h);
        ec_worst_take(&density, fabs(ec_scatter_got(run, EC_SCATTER_D, i) / d - 1), "width %.3g x %.3g, cosine %.8g",
                      along, across, h[2]);
        ec_worst_take(&masking, fabs(ec_scatter_got(run, EC_SCATTER_LAMBDA, i) / lambda - 1),
                      "width %.3g x %.3g, cosine %.8g", along, across, h[2]);
    }
    EC_TRY(ec_selftest_largest(t, "D", density.value, 24 * EC_U, density.note, err));
    return ec_selftest_largest(t, "masking", masking.value, 9 * EC_U, masking.note, err);
}

/* On white metal, and on panes and glass from either side, no sample carries more light than arrives, as with round lobes. Metal's
 * densities are those of Heitz 2018. */
static ec_result samples(ec_selftest *t, ec_scatter_run *run, ec_error *err)
{
    ec_worst gain = {0}, density = {0};
    uint64_t random = 23;
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double eta = ec_random_between(&random, 1.2, 3);
        ec_scatter_material m = i % 3 == 0 ? ec_scatter_metal(1) : ec_scatter_glass(1, i % 3 == 1 ? 1 : i % 2 ? eta : 1 / eta);
        draw_widths(&random, &m);
        if (m.eta != 1) m.alpha = fmax(m.alpha, 1e-4 * fmax(m.eta, 1) / fabs(m.eta - 1)), m.along = fmax(m.along, m.alpha); /* see surface_widen */
        ec_scatter_set(run, i, &m);
        double cosine = i % 2 ? pow(10, ec_random_between(&random, -6, 0)) : ec_random_unit(&random);
        ec_scatter_put_direction(run, EC_SCATTER_WO, i, cosine, 6.3 * ec_random_unit(&random));
        ec_scatter_put3(run, EC_SCATTER_W, i, unit24(&random), unit24(&random), unit24(&random));
    }
    EC_TRY(ec_scatter_go(t, run, err));
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double wo[3], wi[3], along, across, pdf = ec_scatter_got(run, EC_SCATTER_WI_PDF, i);
        if (pdf == 0) continue;
        widths(run, i, &along, &across);
        ec_scatter_given3(run, EC_SCATTER_WO, i, wo);
        ec_scatter_got3(run, EC_SCATTER_WI, i, wi);
        ec_worst_take(&gain, ec_scatter_got(run, EC_SCATTER_WEIGHT, i) - 1,
                      "width %.3g x %.3g, index %.4g, cosine %.3g", along, across,
                      ec_scatter_given(run, EC_SCATTER_ETA, i), wo[2]);
        if (i % 3) continue;
        double h[3] = {wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]}, length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
        for (int k = 0; k < 3; k++) h[k] /= length;
        double exact = exact_ggx(along, across, h) / (2 * (wo[2] + exact_masking(along, across, wo)));
        ec_worst_take(&density, fabs(pdf / exact - 1), "width %.3g x %.3g, wo.z %.3g, wi.z %.3g", along, across, wo[2], wi[2]);
    }
    EC_TRY(ec_selftest_largest(t, "light gained by a sample", gain.value, 1e-3, gain.note, err));
    return ec_selftest_largest(t, "density of samples", density.value, 44 * EC_U, density.note, err);
}

static ec_result brushed_case(ec_selftest *t, ec_error *err)
{
    ec_scatter_run run;
    EC_TRY(ec_scatter_open_with(t, "+EC_FEATURE_ANISOTROPY", &run, err));
    ec_result result = closed_forms(t, &run, err);
    if (result == EC_OK) result = samples(t, &run, err);
    ec_scatter_close(&run);
    return result;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"scatter/brushed", false, brushed_case, "stretched lobes that glow, or that lose their digits across"},
    };
    return RUN_CASES(cases);
}
