#include "jobs/compare_job.h"

#include <stdlib.h>
#include <string.h>

#include "image/error_map.h"
#include "image/flip.h"
#include "image/image.h"
#include "jobs/compare_space.h"

void ec_compare_map(const ec_compare_job *job, uint8_t *rgb)
{
    const ec_measured *a = job->report.a, *b = job->report.b;
    ec_error_map(a->rgb, b->rgb, ec_compare_pixels(job), rgb);
    for (uint64_t p = 0; p < ec_compare_pixels(job); p++)
        if (!ec_counts(a, b, p)) memset(rgb + 3 * p, 128, 3);
}

static ec_result write_map(const char *path, const ec_compare_job *job, ec_error *err)
{
    uint8_t *map = malloc(3 * ec_compare_pixels(job));
    if (!map) return ec_fail(err, "out of memory for '%s'", path);
    ec_compare_map(job, map);
    ec_result result = ec_png_write(path, job->a.measured.width, job->a.measured.height, map, err);
    free(map);
    return result;
}

/* Finds the pixels to compare: those that are opaque in both and white in the mask. */
static ec_result find_mask(ec_compare_job *job, const char *path, ec_error *err)
{
    ec_measured *a = &job->a.measured, *b = &job->b.measured;
    if (!path && !a->mask && !b->mask) return EC_OK;
    if (path) EC_TRY(ec_compare_read_mask(path, a->width, a->height, &job->mask, err));
    if (!job->mask && !(job->mask = malloc(ec_compare_pixels(job)))) return ec_compare_no_memory(job, err);
    if (!path) memset(job->mask, 1, ec_compare_pixels(job));
    for (uint64_t p = 0; p < ec_compare_pixels(job); p++) job->mask[p] = job->mask[p] && ec_counts(a, b, p);
    if (!memchr(job->mask, 1, ec_compare_pixels(job)))
        return ec_fail(err, "cannot compare '%s' with '%s': no pixel is left %s", job->a.path, job->b.path,
                       path ? "by the mask (white is compared)" : "that is opaque; save the picture with a background");
    a->mask = b->mask = job->mask;
    return EC_OK;
}

/* Makes both as they are shown, and FLIP's map. Excluded pixels take B's values in both while they are compared, and A's own again afterwards. */
static ec_result see(ec_compare_job *job, const ec_look *look, ec_error *err)
{
    ec_compare_report *report = &job->report;
    const ec_compare_input *inputs[2] = {&job->a, &job->b};
    const ec_measured *a = report->a, *b = report->b;
    const uint64_t pixels = ec_compare_pixels(job);
    double sum = 0;
    for (int i = 0; i < 2; i++) {
        if (!(job->seen[i] = malloc(3 * pixels * sizeof(float)))) return ec_compare_no_memory(job, err);
        if (report->is_shown) memcpy(job->seen[i], inputs[i]->rgb, 3 * pixels * sizeof(float));
        else ec_show(look, inputs[i]->rgb, pixels, job->seen[i]);
    }
    for (uint64_t p = 0; p < pixels; p++)
        if (!ec_counts(a, b, p)) memcpy(job->seen[0] + 3 * p, job->seen[1] + 3 * p, 3 * sizeof(float));
    if (!(job->flip = malloc(pixels * sizeof(float)))) return ec_compare_no_memory(job, err);
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

ec_result ec_compare_measure(ec_compare_job *job, const ec_compare_options *options, ec_error *err)
{
    ec_compare_report *report = &job->report;
    const ec_measured *a = report->a, *b = report->b;
    ec_look look = options->look;
    if (a->width != b->width || a->height != b->height)
        return ec_fail(err, "cannot compare '%s' with '%s': %ux%u pixels against %ux%u; render both at one --size", report->path_a, report->path_b,
                       a->width, a->height, b->width, b->height);
    EC_TRY(find_mask(job, options->mask, err));
    EC_TRY(ec_compare_bring_together(job, options, &look, err));
    report->difference = ec_measure_difference(a, b);
    report->tested = a->se || b->se;
    if (report->tested) EC_TRY(ec_test_noise(a, b, &report->test, err));
    report->differ = report->tested ? report->test.p < EC_NOISE_SIGNIFICANCE : report->difference.unequal > 0;
    EC_TRY(see(job, &look, err));
    report->diff_path = options->diff;
    return options->diff ? write_map(options->diff, job, err) : EC_OK;
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
