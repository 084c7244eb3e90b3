/* tier: full */
/* Reflectance of an interface between two dielectrics, and the direction of the transmitted light. */
#include "robust/cases.h"
#include "robust/scatter.h"

static const double indices[] = {1.5, 1 / 1.5, 2.4, 1 / 2.4, 1.01, 1 / 1.01, 1 + 0x1p-20, 1 - 0x1p-20};
enum { INDICES = sizeof indices / sizeof indices[0], EACH = EC_SCATTER_N / INDICES };

/* Cosines from grazing to head-on. Every fourth is within 2^-15 of the critical angle, that is, neighbouring floats. */
static double cosine_of(double eta, uint32_t i)
{
    double all = (i + 0.5) / EACH, critical = sqrt(fmax(1 - eta * eta, 0));
    if (i % 4 == 3) return (double)(float)critical + ((double)(i / 4) - EACH / 8) * 0x1p-25;
    return i % 4 == 1 ? pow(10, -7 * all) : all;
}

/* Both polarisations are (a - b) / (a + b), of terms with three roundings each: their squares are off by 8 u of 1. At the critical angle
 * cos^2 + eta^2 - 1 cancels. Its relative error is u, since the code adds back the terms' rounding errors. Without that the reflectance
 * would be wrong by 5e-4. */
static ec_result reflectances(ec_selftest *t, ec_scatter_run *run, ec_error *err)
{
    ec_worst anywhere = {0}, critical = {0};
    uint64_t rising = 0, leaks = 0, total = 0;
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        ec_scatter_material m = ec_scatter_glass(1e-4, indices[i / EACH]);
        ec_scatter_set(run, i, &m);
        ec_scatter_put3(run, EC_SCATTER_W, i, 0, 0,
                        fmin(fmax(cosine_of(ec_scatter_given(run, EC_SCATTER_ETA, i), i % EACH), 0x1p-30), 1));
    }
    EC_TRY(ec_scatter_go(t, run, err));
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double eta = ec_scatter_given(run, EC_SCATTER_ETA, i), cosine = ec_scatter_given(run, EC_SCATTER_W + 2, i);
        double got = ec_scatter_got(run, EC_SCATTER_FRESNEL, i), exact = ec_exact_fresnel(cosine, eta);
        bool near = eta < 1 && i % 4 == 3;
        ec_worst_take(near ? &critical : &anywhere, fabs(got - exact), "index %.7g, cosine %.8g: %.8g", eta, cosine, got);
        if (i >= 4 && i % EACH >= 4 && i % 4 == 3) /* the previous one, at a smaller cosine */
            rising += !(got <= ec_scatter_got(run, EC_SCATTER_FRESNEL, i - 4) + 16 * EC_U);
        if (eta < 1 && cosine * cosine + eta * eta < 1) leaks += got != 1, total++;
    }
    EC_TRY(ec_selftest_largest(t, "reflectance", anywhere.value, 16 * EC_U, anywhere.note, err));
    EC_TRY(ec_selftest_largest(t, "reflectance next to the critical angle", critical.value, 16 * EC_U, critical.note, err));
    EC_TRY(ec_selftest_none(t, "reflectance that rises towards head-on", rising, EC_SCATTER_N / 4, NULL, err));
    return ec_selftest_none(t, "light out beyond the critical angle", leaks, total, NULL, err);
}

/* Smooth white glass: each of the two directions carries all light, with weights R / R and (1 - R) / (1 - R), after twelve roundings of
 * probabilities and luminances, and is chosen as often as R says. The refracted one follows Snell's law; its rounding error is divided by
 * the index. */
static ec_result directions(ec_selftest *t, ec_scatter_run *run, ec_error *err)
{
    ec_worst weight = {0}, direction = {0};
    uint64_t wrong = 0;
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        ec_scatter_material m = ec_scatter_glass(1e-4, indices[i / EACH]);
        m.smooth = true;
        ec_scatter_set(run, i, &m);
        double cosine = fmin(fmax(cosine_of(ec_scatter_given(run, EC_SCATTER_ETA, i), i % EACH), 1e-6), 1);
        ec_scatter_put_direction(run, EC_SCATTER_WO, i, cosine, i);
        ec_scatter_put3(run, EC_SCATTER_W, i, 0.3, 0.6, i / 4 % 2 ? 1 - EC_U : 0);
    }
    EC_TRY(ec_scatter_go(t, run, err));
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        double eta = ec_scatter_given(run, EC_SCATTER_ETA, i), wo[3], wi[3], exact[3];
        ec_scatter_given3(run, EC_SCATTER_WO, i, wo);
        ec_scatter_got3(run, EC_SCATTER_WI, i, wi);
        double beyond2 = 1 - (1 - wo[2]) * (1 + wo[2]) / (eta * eta);
        bool passes = i / 4 % 2 && beyond2 > 0;
        for (int k = 0; k < 2; k++) exact[k] = -wo[k] / (passes ? eta : 1);
        exact[2] = passes ? -sqrt(beyond2) : wo[2];
        wrong += !(ec_scatter_got(run, EC_SCATTER_WI_PDF, i) == -1) || (wi[2] < 0) != passes;
        double reflectance = ec_exact_fresnel(wo[2], eta), share = i / 4 % 2 ? (passes ? 1 - reflectance : 1) : reflectance;
        const char *way = passes ? "refracted" : "reflected";
        ec_worst_take(&weight, share * fabs(ec_scatter_got(run, EC_SCATTER_WEIGHT, i) - 1),
                      "index %.7g, cosine %.8g, %s", eta, wo[2], way);
        for (int k = 0; k < 3; k++)
            ec_worst_take(&direction, fabs(wi[k] - exact[k]) * fmin(eta, 1), "index %.7g, cosine %.8g, %s", eta, wo[2], way);
    }
    EC_TRY(ec_selftest_none(t, "smooth glass, wrong side or density", wrong, EC_SCATTER_N, NULL, err));
    EC_TRY(ec_selftest_largest(t, "smooth glass, R + T", weight.value, 12 * EC_U, weight.note, err));
    return ec_selftest_largest(t, "Snell's law", direction.value, 6 * EC_U, direction.note, err);
}

/* Equal indices reflect nothing, exactly. */
static ec_result nothing(ec_selftest *t, ec_scatter_run *run, ec_error *err)
{
    uint64_t wrong = 0;
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) {
        ec_scatter_material m = ec_scatter_glass(1e-4, 1);
        ec_scatter_set(run, i, &m);
        ec_scatter_put3(run, EC_SCATTER_W, i, 0, 0, pow(10, -7.0 * i / EC_SCATTER_N));
    }
    EC_TRY(ec_scatter_go(t, run, err));
    for (uint32_t i = 0; i < EC_SCATTER_N; i++) wrong += !(ec_scatter_got(run, EC_SCATTER_FRESNEL, i) == 0);
    return ec_selftest_none(t, "reflected at index 1", wrong, EC_SCATTER_N, NULL, err);
}

static ec_result fresnel_case(ec_selftest *t, ec_error *err)
{
    ec_scatter_run run;
    EC_TRY(ec_scatter_open(t, &run, err));
    ec_result result = reflectances(t, &run, err);
    if (result == EC_OK) result = directions(t, &run, err);
    if (result == EC_OK) result = nothing(t, &run, err);
    ec_scatter_close(&run);
    return result;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"scatter/fresnel", false, fresnel_case, "black or bright rims where total reflection sets in"},
    };
    return RUN_CASES(cases);
}
