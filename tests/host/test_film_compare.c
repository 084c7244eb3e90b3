/* tiers: quick, full */
/* The figures of a comparison against sums by hand, and the noise test on synthetic pictures: how often pairs of one truth raise an alarm,
 * and which differences are found. tests/stat/test_false_alarms.c does so on renders. */
#include "film/difference.h"
#include "film/noise_test.h"
#include "film/resolve.h"
#include "film/statistics.h"
#include "support/films.h"
#include "support/random.h"
#include "support/test.h"

enum { W = 40, H = 30, VALUES = 3 * W * H, PAIRS = 200 };

typedef struct picture {
    float rgb[VALUES], se[VALUES];
    ec_measured measured;
} picture;

static test_random rng = {1};

/* The mean of `each` samples; their normal parts are drawn as one number. */
static double normal_noise(double truth, int each) { return truth * (1 + 0.3 / sqrt(each) * test_normal(&rng)); }
static double fireflies(double truth, int each)
{
    int bright = 0;
    for (int i = 0; i < each; i++) bright += test_uniform(&rng) < 0.02;
    return truth * (1 + 0.02 / sqrt(each) * test_normal(&rng) + 30.0 * bright / each);
}

/* A render of a picture whose brightness rises from left to right, with black columns at the right. Up to 16 samples are replicates of one
 * sample; more are divided equally among 16 replicates. */
static void render(picture *out, int samples, double (*noise)(double, int), double brightness)
{
    ec_film film;
    ec_error err;
    const int replicates = samples < 16 ? samples : 16, each = samples / replicates;
    CHECK_OK(ec_film_create(&film, W, H, (uint32_t)replicates, &err), err);
    for (int b = 0; b < replicates; b++) {
        static float batch[VALUES];
        for (int p = 0; p < W * H; p++) {
            const double truth = p % W < W - 4 ? 0.1 + 0.02 * (p % W) : 0, x = truth > 0 ? brightness * noise(truth, each) : 0;
            for (int c = 0; c < 3; c++) batch[3 * p + c] = (float)(x * (1 + 0.2 * c));
        }
        CHECK_OK(films_add(&film, (uint32_t)b, batch, &err), err);
    }
    ec_film_resolve(&film, out->rgb, out->se);
    ec_film_destroy(&film);
    out->measured = (ec_measured){W, H, out->rgb, out->se, NULL, replicates, samples, 0};
}

static ec_noise_test compare(const picture *a, const picture *b)
{
    ec_noise_test test;
    ec_error err;
    CHECK_OK(ec_test_noise(&a->measured, &b->measured, &test, &err), err);
    CHECK(test.p >= 0 && test.p <= 1);
    return test;
}

static void figures_are_those_of_the_definitions(void)
{
    const float a[6] = {1, 2, 3, 0, 0, 0}, b[6] = {1, 1, 1, 0.5f, 0, 0}, se[6] = {0.1f, 0.1f, 0.1f, 0, 0, 0}, se_y[2] = {0.07f, 0};
    ec_measured ma = {2, 1, a, se, se_y, 4, 16, 0}, mb = {2, 1, b, NULL, NULL, INFINITY, 0, 0};
    ec_difference d = ec_measure_difference(&ma, &mb);
    double ya = 0.2126 + 2 * 0.7152 + 3 * 0.0722, first = ya - 1, second = 0.5 * 0.2126, mean_b = (1 + second) / 2;
    CHECK(d.unequal == 2);
    CHECK_NEAR(d.mean_a, ya / 2, 1e-12);
    CHECK_NEAR(d.rmse, sqrt((1 + 4 + 0.25) / 6), 1e-12);
    CHECK_NEAR(d.relative_rms, sqrt((first * first + second * second) / 2) / mean_b, 1e-12);
    CHECK_NEAR(d.relmse, (5 / (1.01 * 1.01) + 0.25 / (0.51 * 0.51)) / 6, 1e-12);
    CHECK_NEAR(d.mape, (3 / 1.01 + 0.5 / 0.51) / 6, 1e-12);
    CHECK_NEAR(d.psnr, 10 * log10(1 / (5.25 / 6)), 1e-12);
    CHECK_NEAR(d.noise_relative_rms, sqrt(0.07 * 0.07 / 2) / mean_b, 1e-8);
    CHECK_NEAR(d.noise_relmse, 0.03 / (1.01 * 1.01) / 6, 1e-8);
    ma.se_y = NULL; /* then as many as all channels together allow */
    CHECK_NEAR(ec_measure_difference(&ma, &mb).noise_relative_rms, sqrt(0.1 * 0.1 / 2) / mean_b, 1e-8);
    d = ec_measure_difference(&mb, &mb);
    CHECK(d.unequal == 0 && d.rmse == 0 && d.relative_rms == 0 && isinf(d.psnr) && isnan(d.noise_relmse));
}

static void p_values_combine(void)
{
    const double alike[4] = {1, 1, 1, 1}, same[4] = {0.03, 0.03, 0.03, 0.03}, none[4] = {1, 1, 1, 1}, sure[4] = {0.5, 0, 1, 1},
                 one[4] = {1e-9, 0.5, 0.5, 0.5};
    CHECK_NEAR(ec_p_combined(same, alike, 4), 0.03, 1e-12);
    CHECK(ec_p_combined(none, alike, 4) > 0.89);
    CHECK(ec_p_combined(sure, alike, 4) == 0);
    CHECK_NEAR(ec_p_combined(one, alike, 4), 4e-9, 1e-11); /* Bonferroni's correction */
    CHECK_NEAR(ec_p_of_least(0.001, 100), 1 - pow(0.999, 100), 1e-12);
    CHECK_NEAR(ec_p_of_least(1e-20, 1e6), 1e-14, 1e-20);
    CHECK(ec_p_of_least(1, 5) == 1 && ec_p_of_least(0, 5) == 0);
    CHECK_NEAR(ec_binomial_upper_tail(1, 10, 0.1), 1 - pow(0.9, 10), 1e-12);
    CHECK_NEAR(ec_binomial_upper_tail(10, 10, 0.1), 1e-10, 1e-16);
    CHECK(ec_binomial_upper_tail(0, 10, 0.1) == 1);
}

/* Pairs of one truth. At 5 % of 200, 18 or more alarms happen in 1 of 70 cases. No alarm at all is no fault, since in pixels and blocks the
 * test is conservative. */
static void equal_truths_raise_few_alarms(void)
{
    static const struct { const char *name; double (*noise)(double, int); int a, b; } cases[] = {
        {"normal noise, 16 and 16 samples", normal_noise, 16, 16}, {"normal noise, 4 and 64 samples", normal_noise, 4, 64},
        {"normal noise, 2 and 2 samples", normal_noise, 2, 2},     {"fireflies, 16 and 16 samples", fireflies, 16, 16},
        {"fireflies, 8 and 192 samples", fireflies, 8, 192},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        int alarms[2] = {0};
        double mean = 0;
        for (int i = 0; i < PAIRS; i++) {
            static picture a, b;
            render(&a, cases[k].a, cases[k].noise, 1);
            render(&b, cases[k].b, cases[k].noise, 1);
            ec_noise_test test = compare(&a, &b);
            CHECK(test.exact_unequal == 0);
            alarms[0] += test.p < 0.05;
            alarms[1] += test.p < 0.01;
            mean += test.p_mean < 0.05;
        }
        printf("%-34s alarms %d at 5 %%, %d at 1 %% of %d pairs; mean alone %.0f at 5 %%\n", cases[k].name, alarms[0], alarms[1], PAIRS, mean);
        CHECK_MSG(alarms[0] <= 17 && alarms[1] <= 6, "%s", cases[k].name);
    }
}

static void brighter_pictures_are_found(void)
{
    static picture a, b;
    int found = 0;
    for (int i = 0; i < 20; i++) { /* noise of each mean: 0.3 / sqrt(1080 x 16), so 2 % is 6 standard errors */
        render(&a, 16, normal_noise, 1.02);
        render(&b, 16, normal_noise, 1);
        ec_noise_test test = compare(&a, &b);
        found += test.p < EC_NOISE_SIGNIFICANCE;
        if (i == 0) CHECK_MSG(fabs(test.mean_t[1] - 6) < 3.5 && test.mean_difference[1] > 0, "t %g", test.mean_t[1]);
    }
    CHECK_MSG(found >= 18, "%d of 20", found);
}

static void one_block_and_one_pixel_are_found(void)
{
    static picture a, b;
    render(&a, 16, normal_noise, 1);
    render(&b, 16, normal_noise, 1);
    for (int y = 8; y < 16; y++)
        for (int x = 24; x < 32; x++) a.rgb[3 * (y * W + x) + 1] *= 1.12f;
    ec_noise_test test = compare(&a, &b);
    CHECK_MSG(test.p_blocks < 1e-4 && test.p < 0.01 && test.p_blocks < test.p_mean, "p %g, blocks %g", test.p, test.p_blocks);
    CHECK_MSG(test.block.x == 24 && test.block.y == 8 && test.block.channel == 1 && test.block.t > 5, "(%u, %u)", test.block.x, test.block.y);

    render(&a, 16, normal_noise, 1);
    a.rgb[3 * (20 * W + 7)] *= 4;
    test = compare(&a, &b);
    CHECK_MSG(test.p_pixels < 1e-6 && test.p < 1e-4, "p %g, pixels %g", test.p, test.p_pixels);
    CHECK(test.pixel.x == 7 && test.pixel.y == 20 && test.pixel.channel == 0);
}

/* 5 % of the values are far off, none of them impossibly: their share raises the alarm. */
static void many_outliers_are_found(void)
{
    static picture a, b;
    render(&a, 64, normal_noise, 1);
    render(&b, 64, normal_noise, 1);
    for (int i = 0; i < VALUES; i += 20) a.rgb[i] += (i / 20 % 2 ? 4.5f : -4.5f) * a.se[i];
    ec_noise_test test = compare(&a, &b);
    double share = (double)test.outlying / (double)test.judged;
    CHECK_MSG(test.p_share < 1e-6 && test.p < 0.01 && share > 0.015, "p %g, share %g", test.p_share, share);
}

static void exact_values_must_be_equal(void)
{
    static picture a, b;
    render(&a, 16, normal_noise, 1);
    render(&b, 16, normal_noise, 1);
    int black = 3 * (9 * W + W - 1); /* in the black columns, three pixels from any noise */
    a.rgb[black] = 1e-6f;
    ec_noise_test test = compare(&a, &b);
    CHECK(test.p == 0 && test.exact_unequal == 1 && test.exact_x == W - 1 && test.exact_y == 9);
    for (int i = 0; i < VALUES; i++) a.se[i] = b.se[i] = 0, b.rgb[i] = nextafterf(a.rgb[i], 9);
    b.rgb[black] = a.rgb[black] = 0;
    for (int i = 0; i < VALUES; i++)
        if (a.rgb[i] == 0) b.rgb[i] = 0;
    test = compare(&a, &b);
    CHECK_MSG(test.p > 0.89 && test.exact_unequal == 0, "p %g, %llu", test.p, (unsigned long long)test.exact_unequal);
    a.rgb[0] *= 1.0003f; /* below the resolution of a half */
    CHECK(compare(&a, &b).exact_unequal == 1);
    a.measured.is_half = 1;
    CHECK(compare(&a, &b).exact_unequal == 0);
}

/* A pixel in which all replicates agree, among noisy pixels: by chance, or since a rare path was missed. No alarm. */
static void a_calm_pixel_among_noisy_ones_is_judged_by_them(void)
{
    static picture a, b;
    render(&a, 16, normal_noise, 1);
    render(&b, 16, normal_noise, 1);
    for (int c = 0; c < 3; c++) {
        int i = 3 * (5 * W + 8) + c;
        a.se[i] = b.se[i] = 0;
        a.rgb[i] = 1.05f * b.rgb[i];
    }
    ec_noise_test test = compare(&a, &b);
    CHECK_MSG(test.p > 0.01 && test.exact_unequal == 0, "p %g", test.p);
}

/* A pixel in which replicates hardly differ, ten standard errors of its neighbours off: an alarm, unless a curve has changed the noise,
 * whose tails are then unknown. Hundreds of such pixels are an alarm in any case. */
static void bent_noise_has_long_tails(void)
{
    static picture a, b;
    render(&a, 8, normal_noise, 1);
    render(&b, 8, normal_noise, 1);
    for (int k = 0; k < 3; k++) {
        const int i = 3 * (5 * W + 8);
        const float off[] = {14, 14, 300};
        a.se[i] = b.se[i] = 0.05f * a.se[i + 3];
        a.rgb[i] = b.rgb[i] + off[k] * a.se[i + 3];
        a.measured.tail_se = k ? a.se : NULL;
        const ec_noise_test test = compare(&a, &b);
        CHECK_MSG(k == 1 ? test.p > 0.01 : test.p < 0.01, "%d: p %g", k, test.p);
    }
}

static void one_sided_noise_is_enough(void)
{
    static picture a, b;
    render(&a, 16, normal_noise, 1);
    render(&b, 4096, normal_noise, 1);
    b.measured.se = NULL;
    ec_noise_test test = compare(&a, &b);
    CHECK_MSG(test.p > 0.01, "p %g", test.p);
    test = compare(&b, &a);
    CHECK_MSG(test.p > 0.01, "p %g", test.p);
    render(&a, 16, normal_noise, 1.03);
    CHECK(compare(&a, &b).p < 0.01);
}

int main(void)
{
    if (test_tier("full")) {
        a_calm_pixel_among_noisy_ones_is_judged_by_them();
        bent_noise_has_long_tails();
        one_sided_noise_is_enough();
    }
    if (!test_tier("quick")) TEST_END();
    figures_are_those_of_the_definitions();
    p_values_combine();
    equal_truths_raise_few_alarms();
    brighter_pictures_are_found();
    one_block_and_one_pixel_are_found();
    many_outliers_are_found();
    exact_values_must_be_equal();
    TEST_END();
}
