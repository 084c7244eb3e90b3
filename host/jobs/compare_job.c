#include "jobs/compare_job.h"

#include <stdlib.h>

#include "image/error_map.h"
#include "image/image.h"

static ec_result write_map(const char *path, const ec_measured *a, const ec_measured *b, ec_error *err)
{
    uint64_t pixels = (uint64_t)a->width * a->height;
    uint8_t *map = malloc(3 * pixels);
    if (!map) return ec_fail(err, "out of memory for '%s'", path);
    ec_error_map(a->rgb, b->rgb, pixels, map);
    ec_result result = ec_png_write(path, a->width, a->height, map, err);
    free(map);
    return result;
}

ec_result ec_compare_measure(ec_compare_report *report, const char *diff, ec_error *err)
{
    const ec_measured *a = report->a, *b = report->b;
    if (a->width != b->width || a->height != b->height)
        return ec_fail(err, "cannot compare '%s' with '%s': %ux%u pixels against %ux%u; render both at one --size", report->path_a, report->path_b,
                       a->width, a->height, b->width, b->height);
    report->difference = ec_measure_difference(a, b);
    report->tested = a->se || b->se;
    if (report->tested) EC_TRY(ec_test_noise(a, b, &report->test, err));
    report->differ = report->tested ? report->test.p < EC_NOISE_SIGNIFICANCE : report->difference.unequal > 0;
    report->diff_path = diff;
    return diff ? write_map(diff, a, b, err) : EC_OK;
}

ec_result ec_compare_load(const char *path_a, const char *path_b, ec_compare_job *job, ec_error *err)
{
    *job = (ec_compare_job){.report = {.path_a = path_a, .path_b = path_b, .a = &job->a.measured, .b = &job->b.measured}};
    EC_TRY(ec_compare_input_load(path_a, &job->a, err));
    EC_TRY(ec_compare_input_load(path_b, &job->b, err));
    job->report.why_a = job->a.why;
    job->report.why_b = job->b.why;
    return EC_OK;
}

void ec_compare_free(ec_compare_job *job)
{
    ec_compare_input_free(&job->a);
    ec_compare_input_free(&job->b);
}
