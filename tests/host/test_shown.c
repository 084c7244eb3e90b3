/* tier: quick */
/* Noise after tone curves against sampled noise, exposures that are found from pictures, and noise that no file states. */
#include <omp.h>

#include "film/estimated_noise.h"
#include "film/noise_test.h"
#include "image/shown.h"
#include "support/random.h"
#include "support/test.h"

enum { W = 40, H = 32, PIXELS = W * H, VALUES = 3 * PIXELS, SAMPLES = 40000, PAIRS = 100 };

static test_random rng = {7};

/* Moments of one pixel's shown values, whose channels have noise of their own and noise in common. */
static void noise_goes_through_a_curve(ec_tonemap tonemap, const float rgb[3], double alone, double together)
{
    const ec_look look = {.tonemap = tonemap};
    static float all[3 * SAMPLES], shown[3 * SAMPLES]; /* in one call, which starts all threads */
    double sum[3] = {0}, square[3] = {0};
    float se[3], se_y, shown_se[3], slack[3] = {0}, tail_se[3], middle[3];
    ec_show(&look, rgb, 1, middle);
    for (int i = 0; i < SAMPLES; i++) {
        double common = test_normal(&rng);
        for (int c = 0; c < 3; c++) all[3 * i + c] = (float)(rgb[c] * (1 + alone * test_normal(&rng) + together * common));
    }
    ec_show(&look, all, SAMPLES, shown);
    for (int i = 0; i < 3 * SAMPLES; i++) {
        const double off = (double)shown[i] - middle[i % 3];
        sum[i % 3] += off, square[i % 3] += off * off;
    }
    double y2 = 0, y = 0;
    static const double weights[3] = {0.2126, 0.7152, 0.0722};
    for (int c = 0; c < 3; c++) {
        se[c] = (float)(rgb[c] * sqrt(alone * alone + together * together));
        y2 += weights[c] * rgb[c] * alone * weights[c] * rgb[c] * alone;
        y += weights[c] * rgb[c] * together;
    }
    se_y = (float)sqrt(y2 + y * y);
    ec_show_noise(&look, &(ec_measured){.width = 1, .height = 1, .rgb = rgb, .se = se, .se_y = &se_y}, shown_se, &se_y, slack, tail_se);
    for (int c = 0; c < 3; c++) {
        double mean = sum[c] / SAMPLES, deviation = sqrt(square[c] / SAMPLES - mean * mean);
        CHECK_NEAR(shown_se[c], deviation, 0.03 * deviation);
        CHECK(tail_se[c] >= shown_se[c] && tail_se[c] < 2 * deviation);
        CHECK_NEAR(slack[c], fabs(mean), 4 * deviation / sqrt(SAMPLES) + 0.1 * fabs(mean));
    }
}

static void exposure_is_found_again(void)
{
    static float linear[VALUES], shown[VALUES];
    for (int i = 0; i < VALUES; i++) linear[i] = (float)exp(0.8 * test_normal(&rng) - 1);
    for (double stops = -5; stops < 6; stops += 2.7) {
        ec_show(&(ec_look){.exposure = stops}, linear, PIXELS, shown);
        for (int i = 0; i < VALUES; i++) shown[i] = (float)(lrint(255 * shown[i]) / 255.);
        CHECK_NEAR(ec_fit_exposure(&(ec_look){0}, &(ec_measured){.width = W, .height = H, .rgb = linear}, &(ec_measured){.width = W, .height = H, .rgb = shown}), stops, 2e-3);
    }
}

/* Compares 8 bits of a picture that does not state its noise with a picture that does. Returns p. */
static double p_of_pair(double noise, double brightness, double *relative_se)
{
    static float a[VALUES], b[VALUES], se_a[VALUES], se_b[VALUES], slack[VALUES], se_y[PIXELS];
    for (int i = 0; i < VALUES; i++) {
        double truth = 0.2 + 0.01 * (i / 3 % W) + 0.1 * (i % 3);
        a[i] = (float)(lrint(255 * brightness * truth * (1 + noise * test_normal(&rng))) / 255.);
        b[i] = (float)(truth * (1 + 0.01 * test_normal(&rng)));
        se_b[i] = (float)(0.01 * truth);
        slack[i] = 0.6f / 255;
    }
    ec_measured one = {.width = W, .height = H, .rgb = a, .slack = slack, .replicates = EC_ESTIMATED_REPLICATES};
    const ec_measured other = {.width = W, .height = H, .rgb = b, .se = se_b, .replicates = INFINITY};
    ec_noise_test test;
    ec_error err;
    ec_estimate_noise(&one, &other, se_a, se_y);
    one.se = se_a;
    one.se_y = se_y;
    double sum = 0;
    for (int i = 0; i < VALUES; i++) sum += (double)se_a[i] * se_a[i] / ((double)b[i] * b[i]) / VALUES;
    if (relative_se) *relative_se = sqrt(sum);
    CHECK_OK(ec_test_noise(&one, &other, &test, &err), err);
    return test.p;
}

static void noise_is_estimated(void)
{
    int alarms = 0;
    double se;
    for (int k = 0; k < PAIRS; k++) alarms += p_of_pair(0.1, 1, &se) < EC_NOISE_SIGNIFICANCE;
    CHECK_NEAR(se, 0.1, 0.005);
    CHECK_MSG(alarms <= 5, "%d of %d right pictures raised an alarm", alarms, PAIRS); /* 1 % each; more happens in 1 of 1000 runs */
    for (int k = 0; k < 5; k++) CHECK(p_of_pair(0.1, 0.97, NULL) < EC_NOISE_SIGNIFICANCE);
}

int main(void)
{
    noise_goes_through_a_curve(EC_TONEMAP_NONE, (const float[3]){0.3f, 0.2f, 0.4f}, 0, 0.1);
    noise_goes_through_a_curve(EC_TONEMAP_NONE, (const float[3]){0.3f, 0.2f, 0.4f}, 0.1, 0);
    noise_goes_through_a_curve(EC_TONEMAP_NEUTRAL, (const float[3]){2, 1, 0.5f}, 0.05, 0.08);
    omp_set_num_threads(1); /* pictures are so small that threads mostly wait */
    exposure_is_found_again();
    noise_is_estimated();
    TEST_END();
}
