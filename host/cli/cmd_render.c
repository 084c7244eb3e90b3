/* eclat render SCENE: check, load, render, write, tell. */

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "cli/cli.h"
#include "cli/frames.h"
#include "cli/render_job.h"
#include "cli/render_plan.h"
#include "cli/write_report.h"
#include "report/error_text.h"

/* What a slice says of itself, beside its sums. */
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

static ec_result tell(ec_console *console, const ec_render_job *job, const ec_render_report *report, ec_error *err)
{
    if (job->stats.invalid_samples > 0) {
        const ec_log log = ec_console_log(console);
        ec_warn(&log, "%llu samples were not finite and count as black: please report the scene",
                (unsigned long long)job->stats.invalid_samples);
    }
    if (job->request->json) {
        char summary[EC_ERROR_TEXT + 128];
        ec_render_report_summary(report, summary, sizeof summary);
        ec_console_say(console, "%s", summary);
        return ec_render_report_json(report, stdout, err);
    }
    if (!job->request->quiet && !job->share) ec_render_report_text(report, stdout);
    if (!job->request->quiet && job->share) ec_frame_report_text(report, stdout);
    return EC_OK;
}

static ec_result write_film(ec_render_job *job, ec_render_report *report, ec_error *err)
{
    const ec_past past = past_of(job);
    const ec_slice slice = {&job->job, &past};
    return ec_write_report(&job->request->outputs, &job->film, job->request->has_slice ? &slice : NULL, report,
                           job->image_sha256, err);
}

/* Of a picture in strips, whose rows are in the files already. */
static ec_result finish_rows(ec_console *console, ec_render_job *job, ec_render_report *report, ec_error *err)
{
    const ec_log log = ec_console_log(console);
    const uint32_t height = job->request->options.height;
    ec_rows_told told;
    ec_row_writer *rows = job->rows;
    EC_TRY(ec_row_writer_finish(rows, &told, err));
    if (told.rows < height)
        ec_warn(&log, "the strips from row %u on are not complete: they have no samples (0 in the samples channel) and are black", told.rows);
    job->stats.film = told.error;
    report->mean_luminance = told.error.mean_luminance;
    report->replicates = told.replicates;
    job->rows = NULL; /* closing frees it */
    ec_result result = ec_report_rows_close(rows, report, &told, err);
    snprintf(job->image_sha256, sizeof job->image_sha256, "%s", told.sha256);
    report->image_sha256 = job->image_sha256;
    return result;
}

ec_result ec_render_job_deliver(ec_render_job *job, ec_console *console, double start, ec_error *err)
{
    const char *outputs[EC_OUTPUTS_MAX];
    ec_render_report report = ec_render_job_report(job, outputs);
    double write_start = ec_now();
    EC_TRY(job->rows ? finish_rows(console, job, &report, err) : write_film(job, &report, err));
    report.write_seconds = ec_now() - write_start;
    report.total_seconds = ec_now() - start;
    report.peak_memory_bytes = ec_peak_memory_bytes();
    return tell(console, job, &report, err);
}

/* Hours of samples are not to be lost with the device: the picture is written, and the command fails all the same. */
static ec_result render(ec_console *console, ec_render_job *job, double start, ec_error *err)
{
    ec_error why = {0};
    if (ec_render_job_run(job, console, &why) == EC_OK) {
        EC_TRY(ec_render_job_deliver(job, console, start, err));
        return *job->keep_error.text ? ec_fail(err, "%s; the picture is written", job->keep_error.text) : EC_OK;
    }
    bool is_empty = (job->film.batch_count == 0 && !job->rows) || job->stats.samples == 0; /* no samples: a checkpoint that does not fit */
    if (is_empty) return ec_fail(err, "%s", why.text);
    if (job->rows)
        ec_fail(err, "the render failed after %u of %u rows: %s", ec_row_writer_rows(job->rows),
                job->request->options.height, why.text);
    else
        ec_fail(err, "the render failed after %llu samples a pixel: %s",
                (unsigned long long)job->stats.samples_per_pixel, why.text);
    ec_error unwritten = {0};
    if (ec_render_job_deliver(job, console, start, &unwritten) == EC_OK) ec_fail_more(err, "; the picture so far is written");
    else ec_fail_more(err, "; and then: %s", unwritten.text);
    return EC_FAILED;
}

ec_result ec_cmd_render(ec_cli *cli, int argc, char **argv, ec_error *err)
{
    double start = ec_now();
    ec_render_request request = {0};
    bool done = false;
    char folder[PATH_MAX] = "", **as_given = malloc(((size_t)argc + 1) * sizeof *as_given); /* getopt changes their order */
    if (!as_given) return ec_fail(err, "out of memory");
    memcpy(as_given, argv, ((size_t)argc + 1) * sizeof *as_given);
    if (!getcwd(folder, sizeof folder)) folder[0] = 0;
    ec_render_job job = {.request = &request, .takes_several = true, .ranks = cli->ranks, .program = cli->argv[0], .command = cli->line,
                         .job = {.argc = argc, .argv = as_given, .folder = folder}};
    ec_result result = EC_OK;
    EC_TRY_CLEANUP(ec_render_request_parse(argc, argv, &request, &done, err));
    if (done) goto cleanup;
    if (request.resume) EC_TRY_CLEANUP(ec_render_job_take_up(&job, argc, argv, err));
    cli->console.quiet = request.quiet;
    if (request.frames.given) {
        result = ec_frames_render(&cli->console, &request, job.ranks, argc, as_given, start, err);
        goto cleanup;
    }
    if (request.plan_ranks) job.ranks = NULL; /* of one process and its device: what all of them are taken to be */
    result = request.plan_ranks ? ec_render_job_load(&job, &cli->console, err) : ec_render_job_prepare(&job, &cli->console, err);
    if (result == EC_FAILED && request.resume && strcmp(folder, job.job.folder))
        ec_fail_more(err, "; the job was begun in '%s'", job.job.folder);
    if (result != EC_OK) goto cleanup;
    result = request.plan_ranks ? ec_render_plan(&job, &cli->console, err) : render(&cli->console, &job, start, err);
cleanup:
    ec_render_job_free(&job);
    free(as_given);
    return result;
}
