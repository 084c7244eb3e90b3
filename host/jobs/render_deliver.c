/* Delivers a rendered film to its files. */
#include <stdio.h>

#include "base/clock.h"
#include "jobs/render_job.h"
#include "jobs/write_report.h"
#include "report/error_text.h"

/* Collects the statistics that a slice keeps beside its sums. */
static ec_past past_of(const ec_render_job *job)
{
    const ec_render_stats *s = &job->stats;
    return (ec_past){.next = ec_film_end(&job->film),
                     .samples = s->samples,
                     .rays = s->rays,
                     .seconds = s->seconds,
                     .invalid = {[EC_STAGE_GENERATE] = s->invalid_generate,
                                 [EC_STAGE_INTERSECT] = s->invalid_intersect,
                                 [EC_STAGE_SHADE] = s->invalid_shade,
                                 [EC_STAGE_CONNECT] = s->invalid_connect,
                                 [EC_STAGE_ACCUMULATE] = s->invalid_accumulate - job->film.invalid_count},
                     .allotment.gain = 1};
}

ec_result ec_render_job_write(ec_render_job *job, ec_outputs *outputs, ec_render_report *report, ec_error *err)
{
    const ec_past past = past_of(job);
    const ec_slice slice = {&job->job, &past};
    return ec_write_report(outputs, ec_render_channels(job->request), &job->film, job->request->has_slice ? &slice : NULL, report,
                           job->image_sha256, err);
}

ec_result ec_render_job_tell(const ec_render_job *job, const ec_render_report *report, ec_error *err)
{
    const ec_listener *listener = job->listener;
    char summary[EC_ERROR_TEXT + 128];
    if (job->request->json) {
        ec_render_report_summary(report, summary, sizeof summary);
        ec_say(&listener->log, "%s", summary);
        EC_TRY(ec_render_report_json(report, listener->to, err));
    } else if (!job->request->quiet) {
        (report->frame ? ec_frame_report_text : ec_render_report_text)(report, listener->to);
    }
    return listener->report(listener->user, err);
}

/* Finishes a picture rendered in strips, whose rows are already in the files. */
static ec_result finish_rows(ec_render_job *job, ec_render_report *report, ec_error *err)
{
    const uint32_t height = job->request->options.height;
    ec_rows_told told;
    ec_row_writer *rows = job->rows;
    EC_TRY(ec_row_writer_finish(rows, &told, err));
    if (told.rows < height)
        ec_warn(&job->listener->log, "the strips from row %u on are incomplete: they have no samples (0 in the samples channel) and are black", told.rows);
    job->stats.film = told.error;
    report->mean_luminance = told.error.mean_luminance;
    report->replicates = told.replicates;
    job->rows = NULL; /* it is freed on closing */
    ec_result result = ec_report_rows_close(rows, report, &told, err);
    snprintf(job->image_sha256, sizeof job->image_sha256, "%s", told.sha256);
    report->image_sha256 = job->image_sha256;
    return result;
}

ec_result ec_render_job_deliver(ec_render_job *job, double start, ec_error *err)
{
    const char *outputs[EC_OUTPUTS_MAX];
    ec_error undenoised = {0};
    const ec_result denoised = ec_render_job_denoise(job, &undenoised);
    if (denoised != EC_OK) job->denoised = (ec_denoised){.why_not = "it failed"};
    ec_render_report report = ec_render_job_report(job, outputs);
    double write_start = ec_now();
    EC_TRY(job->rows ? finish_rows(job, &report, err) : ec_render_job_write(job, &job->request->outputs, &report, err));
    report.write_seconds = ec_now() - write_start;
    report.total_seconds = ec_now() - start;
    report.peak_memory_bytes = ec_peak_memory_bytes();
    if (job->stats.invalid_samples > 0)
        ec_warn(&job->listener->log, "%llu samples were not finite and count as black; please report the scene", (unsigned long long)job->stats.invalid_samples);
    EC_TRY(ec_render_job_tell(job, &report, err));
    return denoised == EC_OK ? EC_OK : ec_fail(err, "%s; the picture is written as it is", undenoised.text);
}

/* Delivers the picture so far if the device fails, so that hours of samples are not lost. */
ec_result ec_render_job_complete(ec_render_job *job, double start, ec_error *err)
{
    ec_error why = {0};
    if (ec_render_job_run(job, &why) == EC_OK) {
        EC_TRY(ec_render_job_deliver(job, start, err));
        return *job->keep_error.text ? ec_fail(err, "%s; the picture is written", job->keep_error.text) : EC_OK;
    }
    bool is_empty = (job->film.batch_count == 0 && !job->rows) || job->stats.samples == 0; /* no samples of its own: the checkpoint did not fit */
    if (is_empty) return ec_fail(err, "%s", why.text);
    if (job->rows)
        ec_fail(err, "the render failed after %u of %u rows: %s", ec_row_writer_rows(job->rows),
                job->request->options.height, why.text);
    else
        ec_fail(err, "the render failed after %llu samples a pixel: %s",
                (unsigned long long)job->stats.samples_per_pixel, why.text);
    ec_error unwritten = {0};
    if (ec_render_job_deliver(job, start, &unwritten) == EC_OK) ec_fail_more(err, "; the picture so far is written");
    else ec_fail_more(err, "; and then: %s", unwritten.text);
    return EC_FAILED;
}
