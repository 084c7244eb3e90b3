/* Tests whether two renders are the same picture except for noise. Needs both pictures' standard errors.
 *
 * Each value (pixel and channel) gets a two-sided t-test, alpha = 0.01 with Sidak's correction for the number of values; up to 0.25 % may
 * fail, as in Mitsuba 3's test_renders.py. That cannot find a small bias of the whole picture, so the mean of each channel is tested too:
 * |difference| <= 0.1 % of the reference + 4 standard errors.
 *
 *     ztest_picture reference = {0};
 *     CHECK_OK(ztest_load(ECLAT_SHARED "/reference/x.exr", 31, &reference, &err), err);
 *     ztest_picture image = {.width = w, .height = h, .rgb = rgb, .se = stderr_rgb, .dof = batches - 1};
 *     ztest_result r = ztest_compare(&image, &reference, NULL, ECLAT_TEST_OUT "/x-errors.exr");
 *     CHECK_MSG(r.pass, "%s", r.text);
 *     ztest_free(&reference);                                         (only what ztest_load allocated) */
#ifndef EC_TESTS_SUPPORT_ZTEST_H
#define EC_TESTS_SUPPORT_ZTEST_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "film/film.h"
#include "film/statistics.h"
#include "image/image.h"

typedef struct ztest_picture {
    uint32_t width, height;
    float *rgb, *se;   /* 3 per pixel each: mean and its standard error */
    double dof;        /* degrees of freedom of se: batches - 1; INFINITY if se is precise */
} ztest_picture;

/* Zero means the default. */
typedef struct ztest_options {
    double significance;   /* of the whole test of values; 0.01 */
    double outlier_share;  /* share of values that may fail; 0.0025 */
    double floor;          /* least standard error, relative to |reference| + its mean; 1e-4 (rounding, se = 0 by chance) */
    double mean_tolerance; /* relative to the channel's mean; 0.001 */
    double mean_sigmas;    /* standard errors added to it; 4 */
    /* Reference samples per pixel / image samples per pixel, if both were sampled alike: the image's variance is then at least this factor
     * times the reference's. Helps where few batches found a rare light. Default: unused. */
    double variance_ratio;
} ztest_options;

typedef struct ztest_result {
    int pass;
    uint64_t values, outliers;
    double outlier_share;
    double dof, threshold;              /* threshold of the tests of values: a value with |t| above it is an outlier */
    double worst_z;                     /* the largest |t|, signed */
    uint32_t worst_x, worst_y, worst_channel;
    double mean[3], reference_mean[3], mean_difference[3], mean_se[3], mean_z[3];
    char text[640];                     /* one line with the whole result */
} ztest_result;

static inline void ztest_free(ztest_picture *picture)
{
    free(picture->rgb);
    free(picture->se);
    *picture = (ztest_picture){0};
}

/* Reads R, G, B and stderr.R, stderr.G, stderr.B of an EXR file; absent standard errors are 0. */
static inline ec_result ztest_load(const char *path, double dof, ztest_picture *picture, ec_error *err)
{
    static const char *const names[6] = {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"};
    ec_exr exr;
    EC_TRY(ec_exr_read(path, &exr, err));
    uint64_t pixels = (uint64_t)exr.width * exr.height;
    *picture = (ztest_picture){exr.width, exr.height, calloc(pixels, 3 * sizeof(float)),
                               calloc(pixels, 3 * sizeof(float)), dof};
    for (int c = 0; c < 6 && picture->rgb && picture->se; c++) {
        const float *plane = ec_exr_plane(&exr, names[c]);
        for (uint64_t p = 0; plane && p < pixels; p++) (c < 3 ? picture->rgb : picture->se)[3 * p + c % 3] = plane[p];
    }
    ec_exr_free(&exr);
    if (picture->rgb && picture->se) return EC_OK;
    ztest_free(picture);
    return ec_fail(err, "out of memory reading '%s'", path);
}

/* Variances of one value in the image and in the reference. */
typedef struct ztest_variances {
    double image, reference;
} ztest_variances;

static inline ztest_variances ztest_variances_of(const ztest_picture *image, const ztest_picture *reference, uint64_t i,
                                                 const ztest_options *o)
{
    double a = (double)image->se[i] * image->se[i], b = (double)reference->se[i] * reference->se[i];
    return (ztest_variances){fmax(a, b * o->variance_ratio), b};
}

/* Writes the channels of the picture, reference.*, difference.* and z.*. */
static inline ec_result ztest_write_map(const char *path, const ztest_picture *image, const ztest_picture *reference,
                                        const float *z, ec_error *err)
{
    static const char *const names[12] = {"R", "G", "B", "reference.R", "reference.G", "reference.B",
                                          "difference.R", "difference.G", "difference.B", "z.R", "z.G", "z.B"};
    uint64_t values = 3ull * image->width * image->height;
    float *difference = malloc(values * sizeof *difference);
    if (!difference) return ec_fail(err, "out of memory");
    for (uint64_t i = 0; i < values; i++) difference[i] = image->rgb[i] - reference->rgb[i];
    const float *const data[4] = {image->rgb, reference->rgb, difference, z};
    ec_channel channels[12];
    for (int c = 0; c < 12; c++) channels[c] = (ec_channel){.name = names[c], .data = data[c / 3] + c % 3, .stride = 3};
    ec_result result = ec_exr_write(path, image->width, image->height, channels, 12, NULL, 0, err);
    free(difference);
    return result;
}

/* Computes the means of the channels, their difference and its standard error (values are independent); and the degrees of freedom of the
 * tests of values by Welch and Satterthwaite. There is one number of degrees for the whole picture: by value it would be large just where a
 * standard error is small by chance, and with few batches 1 % of equal values would be outliers. */
static inline int ztest_means(const ztest_picture *image, const ztest_picture *reference, const ztest_options *o,
                              ztest_result *r)
{
    double pixels = (double)image->width * image->height, variance[3] = {0}, a = 0, b = 0;
    for (uint64_t i = 0; i < r->values; i++) {
        ztest_variances v = ztest_variances_of(image, reference, i, o);
        r->mean[i % 3] += image->rgb[i] / pixels;
        r->reference_mean[i % 3] += reference->rgb[i] / pixels;
        variance[i % 3] += v.image + v.reference;
        a += v.image;
        b += v.reference;
    }
    double spread = a * a / (o->variance_ratio > 0 ? reference->dof : image->dof) + b * b / reference->dof;
    r->dof = spread > 0 ? (a + b) * (a + b) / spread : INFINITY;
    int pass = 1;
    for (int c = 0; c < 3; c++) {
        r->mean_se[c] = sqrt(variance[c]) / pixels;
        r->mean_difference[c] = r->mean[c] - r->reference_mean[c];
        r->mean_z[c] = r->mean_se[c] > 0 ? r->mean_difference[c] / r->mean_se[c] : 0;
        double limit = o->mean_tolerance * fabs(r->reference_mean[c]) + o->mean_sigmas * r->mean_se[c];
        pass &= fabs(r->mean_difference[c]) <= limit; /* false for NaN */
    }
    return pass;
}

/* Needs the degrees of freedom and means from ztest_means. */
static inline void ztest_values(const ztest_picture *image, const ztest_picture *reference, const ztest_options *o,
                                float *z, ztest_result *r)
{
    /* Sidak 1967: each of n values is tested at 1 - (1 - alpha)^(1/n), here on two sides. */
    double share = -expm1(log1p(-o->significance) / (double)r->values);
    r->threshold = -ec_student_t_quantile(0.5 * share, r->dof);
    double worst = -1;
    for (uint64_t i = 0; i < r->values; i++) {
        ztest_variances v = ztest_variances_of(image, reference, i, o);
        double least = o->floor * (fabs(reference->rgb[i]) + fabs(r->reference_mean[i % 3]));
        double difference = (double)image->rgb[i] - reference->rgb[i];
        double t = difference == 0 ? 0 : difference / sqrt(v.image + v.reference + least * least); /* black: 0 / 0 */
        z[i] = (float)t;
        r->outliers += !(fabs(t) <= r->threshold); /* true for NaN */
        double rank = isnan(t) ? INFINITY : fabs(t);
        if (rank <= worst) continue;
        worst = rank;
        r->worst_z = t;
        r->worst_x = (uint32_t)(i / 3 % image->width);
        r->worst_y = (uint32_t)(i / 3 / image->width);
        r->worst_channel = (uint32_t)(i % 3);
    }
    r->outlier_share = (double)r->outliers / (double)r->values;
}

static inline ztest_options ztest_defaults(const ztest_options *given)
{
    ztest_options o = given ? *given : (ztest_options){0};
    if (o.significance == 0) o.significance = 0.01;
    if (o.outlier_share == 0) o.outlier_share = 0.0025;
    if (o.floor == 0) o.floor = 1e-4;
    if (o.mean_tolerance == 0) o.mean_tolerance = 0.001;
    if (o.mean_sigmas == 0) o.mean_sigmas = 4;
    return o;
}

/* map_path: an EXR written if the test fails; NULL for none. */
static inline ztest_result ztest_compare(const ztest_picture *image, const ztest_picture *reference,
                                         const ztest_options *given, const char *map_path)
{
    ztest_result r = {.values = 3ull * image->width * image->height};
    if (image->width != reference->width || image->height != reference->height) {
        snprintf(r.text, sizeof r.text, "%u x %u pixels against a reference of %u x %u", image->width, image->height,
                 reference->width, reference->height);
        return r;
    }
    ztest_options o = ztest_defaults(given);
    float *z = malloc(r.values * sizeof *z);
    int means_agree = ztest_means(image, reference, &o, &r);
    ztest_values(image, reference, &o, z, &r);
    r.pass = means_agree && r.outlier_share <= o.outlier_share;
    int length = snprintf(r.text, sizeof r.text,
                          "%.4f %% outliers (%.2f %% allowed), worst t %.2f (limit %.2f) at (%u, %u) in %c; "
                          "channel means off by %+.3f %% %+.3f %% %+.3f %% (z %+.1f %+.1f %+.1f)",
                          100 * r.outlier_share, 100 * o.outlier_share, r.worst_z, r.threshold, r.worst_x, r.worst_y,
                          "RGB"[r.worst_channel], 100 * r.mean_difference[0] / r.reference_mean[0],
                          100 * r.mean_difference[1] / r.reference_mean[1],
                          100 * r.mean_difference[2] / r.reference_mean[2], r.mean_z[0], r.mean_z[1], r.mean_z[2]);
    if (!r.pass && map_path && length > 0 && (size_t)length < sizeof r.text) {
        ec_error err = {0};
        int written = ztest_write_map(map_path, image, reference, z, &err) == EC_OK;
        snprintf(r.text + length, sizeof r.text - (size_t)length, written ? "; see %s" : "; no error map: %s",
                 written ? map_path : err.text);
    }
    free(z);
    return r;
}

#endif
