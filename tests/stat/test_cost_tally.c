/* tier: quick */
/* The tally of `eclat cost` on synthetic pictures of known bias and noise, with a reference as noisy as they are. In 60 studies of 4000
 * pixels, the estimates must scatter about the truth by their stated errors. The seed is fixed; each check would fail by chance with at
 * most one of ten thousand seeds. */
#include "cost/cost_internal.h"
#include "support/test.h"

enum { PIXELS = 4000, STUDIES = 60 };

static uint64_t state = 1;

static double uniform(void)
{
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return ((double)(state >> 11) + 0.5) * 0x1p-53;
}
static double normal(void) { return sqrt(-2 * log(uniform())) * cos(2 * acos(-1) * uniform()); }

/* Pixels differ in brightness and in noise. */
static double truth(int p) { return 0.5 + (p % 10) / 9.0; }
static double sigma(int p) { return 0.2 + 0.6 * (p % 7) / 6.0; }
static double reference_sigma(int p) { return 0.05 + 0.1 * (p % 3); }

typedef struct summary {
    double sum, square;
} summary;
static void add(summary *s, double x) { s->sum += x, s->square += x * x; }
static double mean(const summary *s) { return s->sum / STUDIES; }
static double variance(const summary *s) { return (s->square - s->sum * s->sum / STUDIES) / (STUDIES - 1); }

static ec_cost_reference make_reference(void)
{
    ec_cost_reference r = {.luminance = malloc(PIXELS * sizeof(double)), .variance = malloc(PIXELS * sizeof(double)), .mean_luminance = 1};
    for (int p = 0; p < PIXELS; p++) {
        r.luminance[p] = truth(p) + reference_sigma(p) * normal();
        r.variance[p] = reference_sigma(p) * reference_sigma(p);
    }
    return r;
}

/* One study of levels 1, 2, 4, 8 with the given numbers of pictures. */
static ec_cost_row study(double bias, const int pictures[4])
{
    static float rgb[3 * PIXELS];
    ec_error err = {0};
    ec_cost_tally tally;
    ec_cost_row row = {.rung.unbiased = false};
    ec_cost_reference reference = make_reference();
    CHECK_OK(ec_cost_tally_create(&reference, PIXELS, &tally, &err), err);
    for (int level = 0; level < 4; level++) {
        ec_cost_tally_begin(&tally, 1u << level);
        for (int i = 0; i < pictures[level]; i++) {
            for (int p = 0; p < PIXELS; p++) {
                float x = (float)(truth(p) + bias * (p % 2) + sigma(p) / sqrt(1 << level) * normal());
                rgb[3 * p] = rgb[3 * p + 1] = rgb[3 * p + 2] = x;
            }
            ec_cost_tally_add(&tally, rgb);
        }
        ec_cost_tally_end(&tally, &row);
    }
    ec_cost_tally_bias(&tally, &row);
    for (uint32_t i = 0; i < row.point_count; i++) row.points[i].seconds = row.points[i].samples;
    ec_cost_conclude(&row);
    ec_cost_tally_free(&tally);
    ec_cost_reference_free(&reference);
    return row;
}

static void figures_are_honest(double bias)
{
    static const int pictures[4] = {5, 2, 3, 4};
    summary mse[4] = {{0}}, mse_z[4] = {{0}}, bias2 = {0}, bias2_z = {0}, spread = {0};
    double noise = 0, floor = 0;
    int called_biased = 0;
    for (int p = 0; p < PIXELS; p++) {
        noise += sigma(p) * sigma(p) / PIXELS;
        floor += bias * bias * (p % 2) / PIXELS;
    }
    for (int s = 0; s < STUDIES; s++) {
        ec_cost_row row = study(bias, pictures);
        for (int i = 0; i < 4; i++) {
            add(&mse[i], row.points[i].mse);
            add(&mse_z[i], (row.points[i].mse - noise / (1 << i) - floor) / row.points[i].mse_se);
        }
        add(&bias2, row.bias2);
        add(&bias2_z, (row.bias2 - floor) / row.bias2_se);
        add(&spread, row.variance);
        called_biased += row.biased;
    }
    for (int i = 0; i < 4; i++) {
        double expected = noise / (1 << i) + floor, se = sqrt(variance(&mse[i]) / STUDIES);
        printf("bias %g, n = %d: mse %.5f +- %.5f, expected %.5f; its z has variance %.2f\n", bias, 1 << i, mean(&mse[i]), se, expected, variance(&mse_z[i]));
        CHECK_NEAR(mean(&mse[i]), expected, 4 * se);
        CHECK_MSG(variance(&mse_z[i]) > 0.4 && variance(&mse_z[i]) < 1.75, "%g", variance(&mse_z[i]));
    }
    printf("bias %g: bias^2 %.6f +- %.6f, expected %.6f; its z has mean %.2f, variance %.2f; called biased %d of %d times\n", bias, mean(&bias2),
           sqrt(variance(&bias2) / STUDIES), floor, mean(&bias2_z), variance(&bias2_z), called_biased, STUDIES);
    CHECK_NEAR(mean(&bias2), floor, 4 * sqrt(variance(&bias2) / STUDIES));
    /* 60 values: their variance is known to 18 % */
    CHECK_MSG(variance(&bias2_z) > 0.4 && variance(&bias2_z) < 1.75, "%g", variance(&bias2_z));
    CHECK(bias > 0 ? called_biased == STUDIES : called_biased <= 1);
    CHECK_NEAR(mean(&spread), noise, 4 * sqrt(variance(&spread) / STUDIES));
}

/* relMSE: each pixel relative to itself + 0.01, here of the noisy reference. Without noise in the reference it is known exactly. */
static void relative_error(void)
{
    static float rgb[3 * PIXELS];
    ec_error err = {0};
    ec_cost_tally tally;
    ec_cost_row row = {0};
    ec_cost_reference reference = make_reference();
    for (int p = 0; p < PIXELS; p++) {
        reference.luminance[p] = truth(p);
        reference.variance[p] = 0;
        rgb[3 * p] = rgb[3 * p + 1] = rgb[3 * p + 2] = (float)(1.1 * truth(p) + 0.001);
    }
    CHECK_OK(ec_cost_tally_create(&reference, PIXELS, &tally, &err), err);
    ec_cost_tally_begin(&tally, 1);
    ec_cost_tally_add(&tally, rgb);
    ec_cost_tally_add(&tally, rgb);
    ec_cost_tally_end(&tally, &row);
    CHECK_NEAR(row.points[0].relmse, 0.01, 1e-8); /* 0.1 (y + 0.01) of bias */
    ec_cost_tally_free(&tally);
    ec_cost_reference_free(&reference);
}

/* Fully known curves: times to 5, 2, 1 and 0.5 %. */
static void times(void)
{
    ec_cost_row row = {.point_count = 3, .unit = 4, .rung.unbiased = true, .variance = 0.01};
    for (uint32_t i = 0; i < 3; i++) row.points[i] = (ec_cost_point){.samples = 1u << i, .batches = 2, .seconds = 3.0 * (1 << i), .mse = 0.01 / (1 << i), .mse_se = 1e-6};
    ec_cost_conclude(&row);
    CHECK_NEAR(row.fit.slope, -0.5, 1e-9);
    CHECK_NEAR(row.efficiency, 1 / (0.0025 * 12), 1e-6);
    for (int i = 0; i < EC_COST_TARGETS; i++) {
        CHECK_NEAR(row.seconds_to[i], 3 * 0.01 / (ec_cost_targets[i] * ec_cost_targets[i]), 1e-6 * row.seconds_to[i]);
        CHECK(row.extrapolated[i] == (i > 0));
    }
    row.rung.unbiased = false; /* with a floor of 1.5 %: 2 % in finite time, 1 % never */
    row.biased = true;
    row.bias2 = 0.015 * 0.015;
    row.bias2_se = 1e-6;
    ec_cost_conclude(&row);
    CHECK_NEAR(row.seconds_to[1], 3 * 0.01 / (0.02 * 0.02 - row.bias2), 1e-6 * row.seconds_to[1]);
    CHECK(isinf(row.seconds_to[2]) && isinf(row.seconds_to[3]));
    row.biased = false; /* the floor may be up to 1.7 %: nothing is known below that */
    row.bias2 = 1e-4;
    row.bias2_se = 1e-4;
    ec_cost_conclude(&row);
    CHECK(row.seconds_to[1] > 0 && isfinite(row.seconds_to[1]) && isnan(row.seconds_to[2]));
    row.points[2].mse_se = row.points[2].mse; /* only noise: gives no figure */
    row.rung.unbiased = true;
    ec_cost_conclude(&row);
    CHECK(isnan(row.efficiency) && isnan(row.seconds_to[3]) && isnan(row.fit.slope));
}

int main(void)
{
    figures_are_honest(0);
    figures_are_honest(0.3);
    relative_error();
    times();
    TEST_END();
}
