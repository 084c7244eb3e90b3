/* tiers: full, long */
/* Adaptive sampling. It has no bias, though stopping pixels by their own samples would have one; the stated error is the real one; a target
 * is reached with fewer samples where noise is uneven, and with hardly more where it is even; bits do not change. */
#include "film/difference.h"
#include "device/adaptive.h"
#include "support/gltf_writer.h"
#include "support/random.h"
#include "support/render_case.h"

/* ---- synthetic: grey pixels with fireflies 100 times as bright, in one of 200 samples on the left, one of 10 000 on the right; mean 1
 * ---- */

enum { WIDTH = 48, HEIGHT = 32, PIXELS = WIDTH * HEIGHT, REPEATS = 400 };

static test_random state = {3};
static double uniform(void) { return test_uniform(&state); }

/* Takes `samples` more for each entry of the list, or for all pixels. */
static float *draw_batch(const uint32_t *places, uint32_t count, uint32_t samples)
{
    static float batch[EC_BATCH_FIELDS * PIXELS * EC_REPLICATES];
    for (uint32_t p = 0; p < count; p++) {
        double sum = 0, ground = (places ? places[p] : p) % WIDTH < WIDTH / 2 ? 0.5 : 0.99;
        for (uint32_t i = 0; i < samples; i++) sum += uniform() < (1 - ground) / 100 ? 100 + ground : ground;
        float *to = batch + EC_BATCH_FIELDS * p;
        to[0] = to[1] = to[2] = to[EC_BATCH_LARGEST] = (float)(sum / samples);
        to[EC_BATCH_SQUARES] = to[EC_BATCH_FOURTHS] = 1;
    }
    return batch;
}

/* Each replicate of a pixel continues where it ended: no sample is taken twice, and none is left out. taken: by the replicates' numbers in
 * lists. */
static uint32_t count_wrong(const ec_allotment *a, const ec_pass *pass, uint32_t *taken)
{
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < pass->count; i++) {
        const uint32_t *entry = a->list + EC_LIST_WORDS * i, number = entry[0];
        wrong += number / PIXELS != i % EC_REPLICATES || a->place[number % PIXELS] != a->places[i] || entry[1] != taken[number];
        taken[number] += pass->samples;
    }
    return wrong;
}

static void check_bias(void)
{
    double sum = 0, squares = 0;
    int allotted = 0;
    ec_error err;
    const ec_params params = {.width = WIDTH, .height = HEIGHT};
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        ec_film film = {0};
        ec_allotment a;
        CHECK_OK(ec_film_create(&film, WIDTH, HEIGHT, EC_REPLICATES, &err), err);
        for (uint32_t k = 0; !ec_schedule_has_pilot(EC_REPLICATES, k); k++)
            CHECK_OK(ec_film_add(&film, k, draw_batch(NULL, PIXELS, ec_schedule_batch(EC_REPLICATES, k).samples), &err), err);
        CHECK_OK(ec_allot(&film, &params, &a, &err), err);
        allotted += a.weight && a.gain < 0.95;
        static uint32_t taken[PIXELS * EC_REPLICATES];
        for (int i = 0; i < PIXELS * EC_REPLICATES; i++) taken[i] = ec_schedule_pilot(EC_REPLICATES);
        for (double samples = 32; a.weight && samples < 96;) {
            const ec_pass pass = ec_allotment_pass(&a, &film, INFINITY);
            const uint32_t wrong = count_wrong(&a, &pass, taken);
            CHECK_MSG(wrong == 0, "%u of %u entries of a pass do not go on where their replicate is", wrong, pass.count);
            CHECK(pass.count % EC_REPLICATES == 0 && pass.count <= PIXELS * EC_REPLICATES);
            CHECK_OK(ec_film_add_some(&film, draw_batch(a.places, pass.count, pass.samples), NULL, a.places, pass.count, pass.samples, &err), err);
            samples += (double)pass.count * pass.samples / PIXELS;
        }
        double mean = ec_film_estimate_error(&film).mean_luminance;
        sum += mean;
        squares += mean * mean;
        ec_allotment_free(&a);
        ec_film_destroy(&film);
    }
    double mean = sum / REPEATS, se = sqrt((squares / REPEATS - mean * mean) / (REPEATS - 1));
    CHECK_MSG(allotted >= REPEATS * 0.95, "only %d of %d pilots found something to gain", allotted, REPEATS);
    printf("fireflies: mean %.5f +- %.5f of 1\n", mean, se);
    CHECK_MSG(fabs(mean - 1) <= 4 * se && se < 0.003, "mean %g +- %g", mean, se);
}

/* A pass with fewer samples has the first entries of the same list, and only whole pixels. */
static void check_limited_passes(void)
{
    static uint32_t whole[EC_LIST_WORDS * PIXELS * EC_REPLICATES];
    const ec_params params = {.width = WIDTH, .height = HEIGHT};
    ec_film film = {0};
    ec_allotment a;
    ec_error err;
    CHECK_OK(ec_film_create(&film, WIDTH, HEIGHT, EC_REPLICATES, &err), err);
    for (uint32_t k = 0; !ec_schedule_has_pilot(EC_REPLICATES, k); k++)
        CHECK_OK(ec_film_add(&film, k, draw_batch(NULL, PIXELS, ec_schedule_batch(EC_REPLICATES, k).samples), &err), err);
    CHECK_OK(ec_allot(&film, &params, &a, &err), err);
    const ec_pass all = ec_allotment_pass(&a, &film, INFINITY);
    const uint32_t one = EC_REPLICATES * all.samples; /* samples of a pixel in one stride */
    CHECK(all.count > 100 * EC_REPLICATES);
    memcpy(whole, a.list, sizeof *whole * EC_LIST_WORDS * all.count);
    for (uint32_t strides = 0; strides < 100; strides += strides < 5 ? 1 : 19)
        for (uint32_t more = 0; more < one; more += one - 1) {
            const ec_pass pass = ec_allotment_pass(&a, &film, (double)strides * one + more);
            CHECK_MSG(pass.samples == all.samples && pass.count == EC_REPLICATES * (strides ? strides : 1), "%u entries for %u strides", pass.count, strides);
            CHECK(!memcmp(whole, a.list, sizeof *whole * EC_LIST_WORDS * pass.count));
        }
    ec_allotment_free(&a);
    ec_film_destroy(&film);
}

/* ---- renders ---- */

enum { SIZE = 64 };

static case_image render(const ec_scene *scene, bool adaptive, uint32_t spp, double error, uint64_t seed)
{
    ec_render_options o = case_defaults(SIZE, SIZE, spp);
    o.adaptive = adaptive;
    o.error_target = error;
    o.seed = seed;
    return case_render(scene, &o);
}

/* Compares renders with independent seeds with a long one: means, and stated and real errors. */
static void check_renders(const char *path)
{
    enum { RENDERS = 16 };
    ec_scene *scene = case_load(path, NULL);
    case_image reference = render(scene, false, 2048, 0, 999);
    ec_measured converged = {.width = SIZE, .height = SIZE, .rgb = reference.rgb};
    double mean = 0, variance = 0, stated = 0, real = 0;
    for (uint64_t seed = 0; seed < RENDERS; seed++) {
        case_image image = render(scene, true, 128, 0, seed);
        ec_measured measured = {.width = SIZE, .height = SIZE, .rgb = image.rgb};
        ec_difference d = ec_measure_difference(&measured, &converged);
        mean += image.mean[1] / RENDERS;
        variance += image.mean_se[1] * image.mean_se[1] / RENDERS / RENDERS;
        stated += image.stats.film.error * image.stats.film.error / RENDERS;
        real += d.relative_rms * d.relative_rms / RENDERS;
        CHECK(image.film.counts && image.stats.samples_per_pixel >= 127 && image.stats.samples_per_pixel <= 129);
        case_free(&image);
    }
    double own = reference.stats.film.error * reference.stats.film.error;
    double z = (mean - reference.mean[1]) / sqrt(variance + reference.mean_se[1] * reference.mean_se[1]);
    printf("%-24s mean off by %+.1f standard errors (one is %.2f %%), stated over real error %.3f\n", strrchr(path, '/') + 1, z,
           100 * sqrt(variance) / mean, sqrt(stated / (real - own)));
    CHECK_MSG(fabs(z) <= 4, "%s: the mean is off by %.1f standard errors", path, z);
    CHECK_MSG(fabs(stated / (real - own) - 1) < 0.12, "%s: stated square over real %.3f", path, stated / (real - own));
    case_free(&reference);
    ec_scene_free(scene);
}

/* Samples until the bound is reached, relative to uniform sampling. */
static void check_target(const char *path, double target, double most)
{
    ec_scene *scene = case_load(path, NULL);
    case_image even = render(scene, false, 16384, target, 1), adaptive = render(scene, true, 16384, target, 1);
    double ratio = (double)adaptive.stats.samples / (double)even.stats.samples;
    printf("%-24s %g %%: %.0f samples a pixel, %.2f of uniform sampling's\n", strrchr(path, '/') + 1, 100 * target,
           (double)adaptive.stats.samples / SIZE / SIZE, ratio);
    CHECK(!strcmp(even.stats.stopped_by, "error") && !strcmp(adaptive.stats.stopped_by, "error"));
    CHECK_MSG(ratio <= most, "%s: %.2f of uniform sampling's samples", path, ratio);
    /* Both have the same pilot. From there error^2 must fall to the target, less by the gain, and each along its own slope. Forecasts end
     * with a round, at most a quarter later each, and the slopes multiply that. */
    const ec_forecast *a = &adaptive.stats.forecast, *e = &even.stats.forecast;
    const ec_film_forecast of_even = {.samples = e->pilot_samples, .slope = e->slope}, of_adaptive = {.samples = a->pilot_samples, .slope = a->slope};
    const double fall = ec_film_forecast_fall(&of_even, e->samples) * adaptive.stats.allotment_gain;
    double expected = a->pilot_samples;
    while (ec_film_forecast_fall(&of_adaptive, expected) < fall) expected *= 1.01;
    CHECK_MSG(a->samples <= 1.4 * expected && expected <= 1.4 * a->samples, "%s: %.0f samples predicted, not %.0f", path, a->samples, expected);
    case_free(&even);
    case_free(&adaptive);
    ec_scene_free(scene);
}

static void check_bits(const char *path)
{
    static const uint32_t lanes[] = {0, 1, 0}, waves[] = {0, 5000, 20000};
    ec_scene *scene = case_load(path, NULL);
    case_image first = {0};
    for (int i = 0; i < 3; i++) {
        ec_render_options o = case_defaults(61, 37, 64);
        o.adaptive = true;
        o.lanes = lanes[i];
        o.wave = waves[i];
        case_image image = case_render(scene, &o);
        if (i) CHECK_MSG(!memcmp(image.rgb, first.rgb, 3 * 61 * 37 * sizeof(float)), "%s: lanes %u, wave %u", path, lanes[i], waves[i]);
        if (i) case_free(&image);
        else first = image;
    }
    CHECK(first.film.counts);
    case_free(&first);
    ec_scene_free(scene);
}

/* The left half sees the brightest possible environment, the right half an almost black wall: no allotment overflows. */
static void check_overflow(void)
{
    gltf_writer *w = gltf_new();
    gltf_quad(w, gltf_lambert(w, 1e-30, 0), (double[3]){0, -50, 0}, (double[3]){50, 0, 0}, (double[3]){0, 100, 0});
    gltf_camera(w, (double[3]){0, 0, 5}, (double[3]){0, 0, 0}, 1);
    ec_scene *scene = case_load(gltf_write(w, "adaptive-overflow"), "1e30,1e30,1e30");
    ec_render_options o = case_defaults(32, 32, 512);
    o.adaptive = true;
    ec_error err;
    case_image image;
    CHECK_OK(case_try(scene, &o, &image, &err), err);
    CHECK(image.film.counts && image.stats.invalid_samples == 0 && image.film.invalid_count == 0);
    for (uint32_t p = 0; p < 32 * 32; p++)
        if (p % 32 < 15) CHECK_MSG(fabs(image.rgb[3 * p] / 1e30 - 1) < 1e-6, "pixel %u: %g", p, (double)image.rgb[3 * p]);
    case_free(&image);
    ec_scene_free(scene);
    free(w);
}

int main(void)
{
    if (test_tier("full")) {
        check_bias();
        check_limited_passes();
        check_overflow();
        check_renders(OWN_SCENE("ring/ring.gltf"));
        check_target(OWN_SCENE("ring/ring.gltf"), 0.3, 0.5);
        check_target(OWN_SCENE("cornell-box/cornell-box.gltf"), 0.05, 0.8);
        check_bits(OWN_SCENE("ring/ring.gltf"));
    }
    if (test_tier("long")) {
        check_renders(OWN_SCENE("cornell-box/cornell-box.gltf"));
        check_target(OWN_SCENE("furnace/box-materials.gltf"), 0.01, 1.02);
    }
    TEST_END();
}
