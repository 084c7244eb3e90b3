#include "jobs/compare_job.h"

#include <stdlib.h>
#include <string.h>

#include "film/estimated_noise.h"
#include "image/error_map.h"
#include "image/flip.h"
#include "image/image.h"

static uint64_t pixels_of(const ec_compare_job *job)
{
    return (uint64_t)job->a.measured.width * job->a.measured.height;
}

static ec_result out_of_memory(const ec_compare_job *job, ec_error *err)
{
    return ec_fail(err, "out of memory for comparing '%s' with '%s'", job->a.path, job->b.path);
}

void ec_compare_map(const ec_compare_job *job, uint8_t *rgb)
{
    const ec_measured *a = job->report.a, *b = job->report.b;
    ec_error_map(a->rgb, b->rgb, pixels_of(job), rgb);
    for (uint64_t p = 0; p < pixels_of(job); p++)
        if (!ec_counts(a, b, p)) memset(rgb + 3 * p, 128, 3);
}

static ec_result write_map(const char *path, const ec_compare_job *job, ec_error *err)
{
    uint8_t *map = malloc(3 * pixels_of(job));
    if (!map) return ec_fail(err, "out of memory for '%s'", path);
    ec_compare_map(job, map);
    ec_result result = ec_png_write(path, job->a.measured.width, job->a.measured.height, map, err);
    free(map);
    return result;
}

/* The pixels that count, of both: what is opaque in both and white in the mask. */
static ec_result find_mask(ec_compare_job *job, const char *path, ec_error *err)
{
    ec_measured *a = &job->a.measured, *b = &job->b.measured;
    if (!path && !a->mask && !b->mask) return EC_OK;
    if (path) EC_TRY(ec_compare_read_mask(path, a->width, a->height, &job->mask, err));
    if (!job->mask && !(job->mask = malloc(pixels_of(job)))) return out_of_memory(job, err);
    if (!path) memset(job->mask, 1, pixels_of(job));
    for (uint64_t p = 0; p < pixels_of(job); p++) job->mask[p] = job->mask[p] && ec_counts(a, b, p);
    if (!memchr(job->mask, 1, pixels_of(job)))
        return ec_fail(err, "cannot compare '%s' with '%s': no pixel is left %s", job->a.path, job->b.path,
                       path ? "by the mask (white is compared)" : "that is opaque; save the picture with a background");
    a->mask = b->mask = job->mask;
    return EC_OK;
}

/* A linear picture becomes what is shown of it, with its noise. */
static ec_result show(const ec_look *look, ec_compare_input *input, ec_error *err)
{
    ec_measured *m = &input->measured;
    const uint64_t pixels = (uint64_t)m->width * m->height;
    if (m->se) {
        if (!input->slack) input->slack = calloc(3 * pixels, sizeof(float));
        float *se_y = input->se_y ? input->se_y : malloc(pixels * sizeof(float));
        if (!input->slack || !se_y) {
            if (!input->se_y) free(se_y);
            return ec_fail(err, "out of memory for the noise of '%s'", input->path);
        }
        ec_show_noise(look, m, input->se, se_y, input->slack);
        m->se_y = input->se_y = se_y;
        m->slack = input->slack;
    }
    ec_show(look, input->rgb, pixels, input->rgb);
    m->peak = 1;
    return EC_OK;
}

/* A's noise from how it differs from B, which both are as they are compared; linear: B before it was shown, NULL: it was not. */
static ec_result estimate(ec_compare_job *job, const ec_look *look, const float *linear, ec_error *err)
{
    ec_compare_input *a = &job->a;
    a->se = malloc(3 * pixels_of(job) * sizeof(float));
    a->se_y = malloc(pixels_of(job) * sizeof(float));
    if (!a->slack) a->slack = calloc(3 * pixels_of(job), sizeof(float));
    if (!a->se || !a->se_y || !a->slack) return out_of_memory(job, err);
    ec_estimate_noise(&a->measured, &job->b.measured, a->se, a->se_y);
    if (linear) ec_show_bend(look, linear, a->se, pixels_of(job), a->slack);
    a->measured.se = a->se;
    a->measured.se_y = a->se_y;
    a->measured.slack = a->slack;
    a->measured.replicates = EC_ESTIMATED_REPLICATES;
    job->report.is_estimated = true;
    return EC_OK;
}

/* As they are seen. What does not count is B's in both while they are compared, and A's own again after it. */
static ec_result see(ec_compare_job *job, const ec_look *look, ec_error *err)
{
    ec_compare_report *report = &job->report;
    const ec_compare_input *inputs[2] = {&job->a, &job->b};
    const ec_measured *a = report->a, *b = report->b;
    const uint64_t pixels = pixels_of(job);
    double sum = 0;
    for (int i = 0; i < 2; i++) {
        if (!(job->seen[i] = malloc(3 * pixels * sizeof(float)))) return out_of_memory(job, err);
        if (report->is_shown) memcpy(job->seen[i], inputs[i]->rgb, 3 * pixels * sizeof(float));
        else ec_show(look, inputs[i]->rgb, pixels, job->seen[i]);
    }
    for (uint64_t p = 0; p < pixels; p++)
        if (!ec_counts(a, b, p)) memcpy(job->seen[0] + 3 * p, job->seen[1] + 3 * p, 3 * sizeof(float));
    if (!(job->flip = malloc(pixels * sizeof(float)))) return out_of_memory(job, err);
    EC_TRY(ec_flip(job->seen[0], job->seen[1], a->width, a->height, job->flip, err));
    for (uint64_t p = 0; p < pixels; p++) sum += ec_counts(a, b, p) ? job->flip[p] : 0;
    report->flip = sum / (double)report->difference.pixels;
    report->ssim = ec_ssim(job->seen[0], job->seen[1], a->width, a->height, job->mask);
    for (uint64_t p = 0; p < pixels; p++) {
        if (ec_counts(a, b, p)) continue;
        if (report->is_shown) memcpy(job->seen[0] + 3 * p, job->a.rgb + 3 * p, 3 * sizeof(float));
        else ec_show(look, job->a.rgb + 3 * p, 1, job->seen[0] + 3 * p);
    }
    return EC_OK;
}

static void scale(ec_compare_input *input, float factor)
{
    const uint64_t pixels = (uint64_t)input->measured.width * input->measured.height;
    for (uint64_t i = 0; i < 3 * pixels; i++) {
        input->rgb[i] *= factor;
        if (input->se) input->se[i] *= factor;
        if (input->se_y && i < pixels) input->se_y[i] *= factor;
    }
}

/* Of the one that is linear, in its look; of two such A's, which is multiplied, as B is the reference. */
static ec_result fit_exposure(ec_compare_job *job, ec_look *look, ec_error *err)
{
    if (job->a.format && job->b.format)
        return ec_fail(err, "cannot fit an exposure: '%s' and '%s' are both pictures for a screen; leave --fit-exposure out, or give a linear EXR", job->a.path, job->b.path);
    const bool is_a = !job->a.format, is_scaled = is_a && !job->b.format;
    const ec_measured *linear = is_a ? &job->a.measured : &job->b.measured;
    ec_measured other = is_a ? job->b.measured : job->a.measured;
    float *shown = is_scaled ? malloc(3 * pixels_of(job) * sizeof(float)) : NULL;
    if (is_scaled && !shown) return out_of_memory(job, err);
    if (is_scaled) {
        ec_show(look, other.rgb, pixels_of(job), shown);
        other.rgb = shown;
    }
    double fitted = ec_fit_exposure(look, linear, &other);
    free(shown);
    job->report.fitted = is_a ? 'A' : 'B';
    job->report.exposure = is_scaled ? fitted - look->exposure : fitted;
    if (is_scaled) scale(&job->a, (float)exp2(job->report.exposure));
    else look->exposure = fitted;
    return EC_OK;
}

/* Into one space: A and B stay linear, or both become what is shown. *linear: a copy of B's values before that, if it is needed. */
static ec_result bring_together(ec_compare_job *job, const ec_compare_options *options, ec_look *look, float **linear, ec_error *err)
{
    ec_compare_report *report = &job->report;
    report->is_shown = options->is_shown || job->a.format || job->b.format;
    report->tonemap = look->tonemap;
    report->exposure = look->exposure;
    if (options->fits_exposure) EC_TRY(fit_exposure(job, look, err));
    if (!report->is_shown) return EC_OK;
    if (options->estimates_noise && !job->b.format) {
        if (!(*linear = malloc(3 * pixels_of(job) * sizeof(float)))) return out_of_memory(job, err);
        memcpy(*linear, job->b.rgb, 3 * pixels_of(job) * sizeof(float));
    }
    if (!job->a.format) EC_TRY(show(look, &job->a, err));
    return job->b.format ? EC_OK : show(look, &job->b, err);
}

ec_result ec_compare_measure(ec_compare_job *job, const ec_compare_options *options, ec_error *err)
{
    ec_compare_report *report = &job->report;
    const ec_measured *a = report->a, *b = report->b;
    ec_look look = options->look;
    float *linear = NULL;
    ec_result result;
    if (a->width != b->width || a->height != b->height)
        return ec_fail(err, "cannot compare '%s' with '%s': %ux%u pixels against %ux%u; render both at one --size", report->path_a, report->path_b,
                       a->width, a->height, b->width, b->height);
    EC_TRY_CLEANUP(find_mask(job, options->mask, err));
    EC_TRY_CLEANUP(bring_together(job, options, &look, &linear, err));
    if (options->estimates_noise && !a->se) EC_TRY_CLEANUP(estimate(job, &look, linear, err));
    report->difference = ec_measure_difference(a, b);
    report->tested = a->se || b->se;
    if (report->tested) EC_TRY_CLEANUP(ec_test_noise(a, b, &report->test, err));
    report->differ = report->tested ? report->test.p < EC_NOISE_SIGNIFICANCE : report->difference.unequal > 0;
    EC_TRY_CLEANUP(see(job, &look, err));
    report->diff_path = options->diff;
    if (options->diff) EC_TRY_CLEANUP(write_map(options->diff, job, err));
cleanup:
    free(linear);
    return result;
}

ec_result ec_compare_load(const char *path_a, const char *path_b, ec_compare_job *job, ec_error *err)
{
    *job = (ec_compare_job){.report = {.path_a = path_a, .path_b = path_b, .a = &job->a.measured, .b = &job->b.measured}};
    EC_TRY(ec_compare_read(path_a, &job->a, err));
    EC_TRY(ec_compare_read(path_b, &job->b, err));
    job->report.format_a = job->a.format;
    job->report.format_b = job->b.format;
    job->report.is_lossy_a = job->a.is_lossy;
    job->report.why_a = job->a.why;
    job->report.why_b = job->b.why;
    return EC_OK;
}

void ec_compare_free(ec_compare_job *job)
{
    ec_compare_input_free(&job->a);
    ec_compare_input_free(&job->b);
    free(job->mask);
    free(job->seen[0]);
    free(job->seen[1]);
    free(job->flip);
    *job = (ec_compare_job){0};
}
