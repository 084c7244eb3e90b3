#include "jobs/compare_space.h"

#include <stdlib.h>
#include <string.h>

#include "film/estimated_noise.h"

ec_result ec_compare_no_memory(const ec_compare_job *job, ec_error *err)
{
    return ec_fail(err, "out of memory for comparing '%s' with '%s'", job->a.path, job->b.path);
}

/* Replaces a linear picture and its noise by what is shown of them. */
static ec_result show(const ec_look *look, ec_compare_input *input, ec_error *err)
{
    ec_measured *m = &input->measured;
    const uint64_t pixels = (uint64_t)m->width * m->height;
    if (m->se) {
        if (!input->slack) input->slack = calloc(3 * pixels, sizeof(float));
        if (!input->se_y) input->se_y = malloc(pixels * sizeof(float));
        input->tail_se = malloc(3 * pixels * sizeof(float));
        if (!input->slack || !input->se_y || !input->tail_se) return ec_fail(err, "out of memory for the noise of '%s'", input->path);
        ec_show_noise(look, m, input->se, input->se_y, input->slack, input->tail_se);
        m->se_y = input->se_y;
        m->slack = input->slack;
        m->tail_se = input->tail_se;
    }
    ec_show(look, input->rgb, pixels, input->rgb);
    m->peak = 1;
    return EC_OK;
}

/* Estimates A's noise from its difference to B, in the space in which they are compared. linear: B before it was shown; NULL: it was not. */
static ec_result estimate(ec_compare_job *job, const ec_look *look, const float *linear, ec_error *err)
{
    ec_compare_input *a = &job->a;
    a->se = malloc(3 * ec_compare_pixels(job) * sizeof(float));
    a->se_y = malloc(ec_compare_pixels(job) * sizeof(float));
    if (!a->slack) a->slack = calloc(3 * ec_compare_pixels(job), sizeof(float));
    if (!a->se || !a->se_y || !a->slack) return ec_compare_no_memory(job, err);
    ec_estimate_noise(&a->measured, &job->b.measured, a->se, a->se_y);
    if (linear) ec_show_bend(look, linear, a->se, ec_compare_pixels(job), a->slack);
    a->measured.se = a->se;
    a->measured.se_y = a->se_y;
    a->measured.slack = a->slack;
    a->measured.replicates = EC_ESTIMATED_REPLICATES;
    job->report.is_estimated = true;
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

/* Fits the exposure of the linear picture and changes look by it. If both are linear, A is scaled, as B is the reference. */
static ec_result fit_exposure(ec_compare_job *job, ec_look *look, ec_error *err)
{
    if (job->a.format && job->b.format)
        return ec_fail(err, "cannot fit an exposure: '%s' and '%s' are both pictures for a screen; leave --fit-exposure out, or give a linear EXR", job->a.path, job->b.path);
    const bool is_a = !job->a.format, is_scaled = is_a && !job->b.format;
    const ec_measured *linear = is_a ? &job->a.measured : &job->b.measured;
    ec_measured other = is_a ? job->b.measured : job->a.measured;
    float *shown = is_scaled ? malloc(3 * ec_compare_pixels(job) * sizeof(float)) : NULL;
    if (is_scaled && !shown) return ec_compare_no_memory(job, err);
    if (is_scaled) {
        ec_show(look, other.rgb, ec_compare_pixels(job), shown);
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

/* Brings A and B into one space. *linear: a copy of B's values before, if it is needed. */
static ec_result bring_together(ec_compare_job *job, const ec_compare_options *options, ec_look *look, float **linear, ec_error *err)
{
    ec_compare_report *report = &job->report;
    report->is_shown = options->is_shown || job->a.format || job->b.format;
    report->tonemap = look->tonemap;
    report->exposure = look->exposure;
    if (options->fits_exposure) EC_TRY(fit_exposure(job, look, err));
    if (!report->is_shown) return EC_OK;
    if (options->estimates_noise && !job->b.format) {
        if (!(*linear = malloc(3 * ec_compare_pixels(job) * sizeof(float)))) return ec_compare_no_memory(job, err);
        memcpy(*linear, job->b.rgb, 3 * ec_compare_pixels(job) * sizeof(float));
    }
    if (!job->a.format) EC_TRY(show(look, &job->a, err));
    return job->b.format ? EC_OK : show(look, &job->b, err);
}

ec_result ec_compare_bring_together(ec_compare_job *job, const ec_compare_options *options, ec_look *look, ec_error *err)
{
    float *linear = NULL;
    ec_result result = bring_together(job, options, look, &linear, err);
    if (result == EC_OK && options->estimates_noise && !job->a.measured.se) result = estimate(job, look, linear, err);
    free(linear);
    return result;
}
