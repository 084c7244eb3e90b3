/* Renders for tests, in a line or two each:
 *
 *     ec_scene *scene = case_load(path, NULL);            NULL: the file's own light, else white, as `eclat render` does
 *     ec_render_options o = case_options(64, 64, 256);    then set what differs
 *     case_image image = case_render(scene, &o);
 *     CASE_NEAR(&image, expected, 4, 0.001);              within 4 standard errors, and those at most 0.1 %
 *     case_free(&image);
 *     ec_scene_free(scene);
 *
 * The device is ECLAT_DEVICE, else the default. An error that cannot happen in a complete source tree ends the test at once. */
#ifndef EC_TESTS_SUPPORT_RENDER_CASE_H
#define EC_TESTS_SUPPORT_RENDER_CASE_H

#include <math.h>
#include <string.h>
#include <unistd.h>

#include "cl/cl.h"
#include "film/film.h"
#include "film/resolve.h"
#include "render/render.h"
#include "gltf/reader.h"
#include "support/light.h"
#include "support/test.h"
#include "support/ztest.h"

#define SHARED(path) ECLAT_SHARED "/" path
#define OWN_SCENE(path) ECLAT_SOURCE_DIR "/scenes/" path

typedef struct case_image {
    ec_film film;
    ec_render_stats stats;
    uint32_t width, height;
    float *rgb, *se;              /* 3 a pixel */
    double mean[3], mean_se[3];   /* of the whole picture; pixels are independent */
} case_image;

static inline void case_end(const char *what, const ec_error *err)
{
    fprintf(stderr, "%s: %s\n", what, err->text);
    exit(1);
}

static inline int case_present(const char *path) { return access(path, R_OK) == 0; }

/* One device for the whole test. */
static inline ec_cl *case_cl(void)
{
    static ec_cl cl;
    static int is_open;
    if (is_open) return &cl;
    ec_error err = {0};
    ec_device_info *devices;
    uint32_t count, chosen = 0;
    if (ec_devices_list(&devices, &count, &err) != EC_OK) case_end("no device", &err);
    if (ec_device_choose(devices, count, NULL, &chosen, NULL, &err) != EC_OK) case_end("no device", &err);
    if (ec_cl_open(&devices[chosen], &cl, &err) != EC_OK) case_end(devices[chosen].name, &err);
    free(devices);
    is_open = 1;
    return &cl;
}

static inline ec_scene *case_load(const char *path, const char *environment)
{
    ec_error err = {0};
    ec_scene *scene;
    if (ec_scene_load(path, &scene, NULL, &err) != EC_OK) case_end(path, &err);
    if (!environment && !has_light(scene)) environment = "1,1,1";
    if (environment && ec_scene_set_environment(scene, environment, NULL, &err) != EC_OK) case_end(environment, &err);
    return scene;
}

/* Unlimited depth, Sobol, MIS, seed 0. */
/* 16 replicates: 15 degrees of freedom, for which these tests' thresholds of single pixels are made. */
static inline ec_render_options case_options(uint32_t width, uint32_t height, uint32_t spp)
{
    return (ec_render_options){.width = width, .height = height, .spp = spp, .replicates = 16};
}

/* As `eclat render` does by default. */
static inline ec_render_options case_defaults(uint32_t width, uint32_t height, uint32_t spp)
{
    return (ec_render_options){.width = width, .height = height, .spp = spp};
}

/* For tests where compiling takes longer than rendering: narrow kernels compile in a third of the time of wide ones, with the same bits
 * (test_same_bits.c). */
static inline ec_render_options case_quick(ec_render_options options)
{
    options.lanes = 0;
    options.compile = EC_COMPILE_NARROW;
    return options;
}

/* Options for kernels with all effects, which every scene can share. They are narrow, since four lanes with all effects compile for 29 s.
 * Building has compiled some of them. The command line's tests call these options QUICK (tests/cli/support.py). */
static inline ec_render_options case_with_all_effects(ec_render_options options)
{
    setenv("ECLAT_KERNELS", ECLAT_TEST_OUT "/../../eclat-kernels", 1);
    options.all_effects = true;
    options.accel = NULL;
    options.lanes = 0;
    options.compile = EC_COMPILE_NARROW;
    return options;
}

/* For means that are compared within their standard errors: independent random numbers, in 16 replicates. */
static inline ec_render_options case_random(uint32_t size, uint32_t spp, ec_sample sample, uint64_t seed)
{
    ec_render_options o = case_options(size, size, spp);
    o.sampler = EC_SAMPLER_INDEPENDENT;
    o.sample = sample;
    o.seed = seed;
    return o;
}

static inline void case_measure(case_image *image)
{
    double pixels = (double)image->width * image->height, variance[3] = {0};
    memset(image->mean, 0, sizeof image->mean);
    for (uint64_t i = 0; i < 3 * (uint64_t)pixels; i++) {
        image->mean[i % 3] += image->rgb[i] / pixels;
        variance[i % 3] += (double)image->se[i] * image->se[i];
    }
    for (int c = 0; c < 3; c++) image->mean_se[c] = sqrt(variance[c]) / pixels;
}

static inline ec_result case_try(const ec_scene *scene, const ec_render_options *options, case_image *image, ec_error *err)
{
    memset(image, 0, sizeof *image);
    image->width = options->width;
    image->height = options->height;
    uint64_t values = 3ull * options->width * options->height;
    EC_TRY(ec_render(case_cl(), scene, options, NULL, NULL, &image->film, &image->stats, NULL, err));
    image->rgb = malloc(values * sizeof(float));
    image->se = malloc(values * sizeof(float));
    if (!image->rgb || !image->se) return ec_fail(err, "out of memory");
    ec_film_resolve(&image->film, image->rgb, image->se);
    case_measure(image);
    return EC_OK;
}

/* Ends the test if the render fails. NaN and Inf fail the check instead. */
static inline case_image case_render(const ec_scene *scene, const ec_render_options *options)
{
    ec_error err = {0};
    case_image image;
    if (case_try(scene, options, &image, &err) != EC_OK) case_end("render", &err);
    CHECK_MSG(image.stats.invalid_samples == 0, "%llu samples are not finite", (unsigned long long)image.stats.invalid_samples);
    return image;
}

static inline case_image case_render_file(const char *path, const char *environment, const ec_render_options *options)
{
    ec_scene *scene = case_load(path, environment);
    case_image image = case_render(scene, options);
    ec_scene_free(scene);
    return image;
}

/* Names of the effects that were built in. */
static inline const char *case_effects(const case_image *image)
{
    static char text[EC_EFFECT_NAMES];
    ec_feature_names(image->stats.effects.built, text, sizeof text);
    return text;
}

static inline void case_free(case_image *image)
{
    ec_film_destroy(&image->film);
    free(image->rgb);
    free(image->se);
    memset(image, 0, sizeof *image);
}

/* All numbers that samples left in the film. */
static inline int case_same_bits(const ec_film *a, const ec_film *b)
{
    const uint64_t pixels = (uint64_t)a->width * a->height;
    int same = a->width == b->width && a->height == b->height && a->batch_count == b->batch_count && a->cut == b->cut;
    for (uint64_t p = 0; same && p < pixels; p++) {
        ec_pixel x, y;
        memset(&x, 0, sizeof x);
        memset(&y, 0, sizeof y);
        ec_film_look(a, p, 1, &x);
        ec_film_look(b, p, 1, &y);
        same = !memcmp(x.mean, y.mean, sizeof x.mean) && !memcmp(x.m2, y.m2, sizeof x.m2) && x.m3 == y.m3 && x.m4 == y.m4 &&
               x.n == y.n && x.samples == y.samples && !memcmp(x.tail, y.tail, sizeof x.tail);
    }
    for (uint64_t p = 0; same && p < pixels; p++)
        for (uint32_t half = 0; half <= EC_BOTH_HALVES; half++) {
            float x[EC_FILM_FEATURES], y[EC_FILM_FEATURES];
            ec_film_features_of(a, half, p, 1, x);
            ec_film_features_of(b, half, p, 1, y);
            same &= !memcmp(x, y, sizeof x);
        }
    return same;
}

/* For ztest.h; borrows the pixels. */
static inline ztest_picture case_picture(const case_image *image)
{
    return (ztest_picture){image->width, image->height, image->rgb, image->se, ec_film_replicates(&image->film) - 1.0};
}

/* Means of blocks of n x n pixels (n divides both sides), to be freed by ztest_free. Blocks are closer to normal where single pixels'
 * batches are not (rare bright paths). The noise of a reference without standard errors is lower in blocks, too. */
static inline ztest_picture case_blocks(const ztest_picture *p, uint32_t n)
{
    uint32_t w = p->width / n, h = p->height / n;
    ztest_picture out = {w, h, calloc((size_t)w * h, 12), calloc((size_t)w * h, 12), p->dof};
    if (!out.rgb || !out.se) exit(1);
    for (size_t i = 0; i < 3 * (size_t)w * h; i++) {
        double sum = 0, variance = 0;
        size_t x0 = i / 3 % w * n, y0 = i / 3 / w * n;
        for (size_t y = y0; y < y0 + n; y++)
            for (size_t x = x0; x < x0 + n; x++) {
                size_t at = 3 * (y * p->width + x) + i % 3;
                sum += p->rgb[at];
                variance += (double)p->se[at] * p->se[at];
            }
        out.rgb[i] = (float)(sum / n / n);
        out.se[i] = (float)(sqrt(variance) / n / n);
    }
    return out;
}

/* The mean of one channel over pixels [x0, x1) x [y0, y1), and its standard error. */
static inline double case_region(const case_image *image, const uint32_t box[4], int channel, double *se)
{
    double sum = 0, variance = 0, n = (double)(box[1] - box[0]) * (box[3] - box[2]);
    for (uint32_t y = box[2]; y < box[3]; y++)
        for (uint32_t x = box[0]; x < box[1]; x++) {
            size_t i = 3 * ((size_t)y * image->width + x) + (size_t)channel;
            sum += image->rgb[i];
            variance += (double)image->se[i] * image->se[i];
        }
    *se = sqrt(variance) / n;
    return sum / n;
}

/* Compares the picture's mean with a known number, in every channel: within `sigmas` standard errors and 2e-6 for float rounding. The
 * standard error must be at most `most_se` of the expected value, or the test would prove nothing. */
#define CASE_NEAR(image, expected, sigmas, most_se)                                                                    \
    do {                                                                                                               \
        for (int c_ = 0; c_ < 3; c_++) {                                                                               \
            double e_ = (expected), d_ = (image)->mean[c_] - e_, s_ = (image)->mean_se[c_];                            \
            CHECK_MSG(fabs(d_) <= (sigmas) * s_ + 2e-6 * fabs(e_) && s_ <= (most_se) * fabs(e_),                       \
                      "channel %d: %.8g +- %.2g, expected %.8g (off by %.1f standard errors, %.2g %%)", c_,            \
                      (image)->mean[c_], s_, e_, s_ > 0 ? d_ / s_ : 0, e_ != 0 ? 100 * d_ / e_ : 0);                   \
        }                                                                                                              \
    } while (0)

/* Compares two renders of one converged picture, in squares of `block` pixels: ztest.h without allowance for a common bias. */
static inline void case_check_same(const case_image *a, const case_image *b, uint32_t block, const char *what)
{
    ztest_picture one = case_picture(a), two = case_picture(b);
    ztest_picture image = case_blocks(&one, block), reference = case_blocks(&two, block);
    ztest_options options = {.mean_tolerance = 1e-5};
    ztest_result r = ztest_compare(&image, &reference, &options, NULL);
    CHECK_MSG(r.pass, "%s: %s", what, r.text);
    printf("%-44s %s\n", what, r.text);
    ztest_free(&image);
    ztest_free(&reference);
}

#endif
