/* eclat render SCENE: check, load, render, write, tell. */

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "cli/cli.h"
#include "cli/render_job.h"
#include "cli/render_plan.h"
#include "cli/write_report.h"

/* The finished job in figures. Texts are the job's. */
static ec_render_report make_report(const ec_render_job *job, const char **outputs)
{
    const ec_render_request *request = job->request;
    for (int i = 0; i < request->outputs.count; i++) outputs[i] = request->outputs.file[i].path;
    return (ec_render_report){
        .command = job->command,
        .scene = request->scene,
        .camera = job->camera_text,
        .viewpoint = job->viewpoint,
        .environment = job->environment_text,
        .options = &request->options,
        .stats = &job->stats,
        .verbose = request->verbose,
        .device = job->devices,
        .device_why = job->device_why,
        .device_index = job->device_indices,
        .exposure = request->exposure,
        .tonemap = request->tonemap,
        .mean_luminance = ec_film_estimate_error(&job->film).mean_luminance,
        .batches = job->film.batch_count,
        .load_seconds = job->load_seconds,
        .image_sha256 = job->image_sha256,
        .outputs = outputs,
        .output_count = request->outputs.count,
    };
}

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
        char summary[256];
        ec_render_report_summary(report, summary, sizeof summary);
        ec_console_say(console, "%s", summary);
        return ec_render_report_json(report, stdout, err);
    }
    if (!job->request->quiet) ec_render_report_text(report, stdout);
    return EC_OK;
}

static ec_result deliver(ec_console *console, ec_render_job *job, double start, ec_error *err)
{
    const char *outputs[EC_OUTPUTS_MAX];
    ec_render_report report = make_report(job, outputs);
    double write_start = ec_now();
    const ec_past past = past_of(job);
    const ec_slice slice = {&job->job, &past};
    EC_TRY(ec_write_report(&job->request->outputs, &job->film, job->request->has_slice ? &slice : NULL, &report, job->image_sha256, err));
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
        EC_TRY(deliver(console, job, start, err));
        return *job->keep_error.text ? ec_fail(err, "%s; the picture is written", job->keep_error.text) : EC_OK;
    }
    bool is_empty = job->film.batch_count == 0 || job->stats.samples == 0; /* no samples: a checkpoint that does not fit */
    if (is_empty) return ec_fail(err, "%s", why.text);
    ec_fail(err, "the render failed after %llu samples a pixel: %s", (unsigned long long)job->stats.samples_per_pixel, why.text);
    ec_error unwritten = {0};
    if (deliver(console, job, start, &unwritten) == EC_OK) ec_fail_more(err, "; the picture so far is written");
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
    ec_render_job job = {.request = &request, .takes_several = true, .ranks = cli->ranks, .command = cli->line, .job = {.argc = argc, .argv = as_given, .folder = folder}};
    ec_result result = EC_OK;
    EC_TRY_CLEANUP(ec_render_request_parse(argc, argv, &request, &done, err));
    if (done) goto cleanup;
    if (request.resume) EC_TRY_CLEANUP(ec_render_job_take_up(&job, argc, argv, err));
    cli->console.quiet = request.quiet;
    if (request.plan_ranks) job.takes_several = false, job.ranks = NULL; /* of one device and one process: what all of them are taken to be */
    result = request.plan_ranks ? ec_render_job_load(&job, &cli->console, err) : ec_render_job_prepare(&job, &cli->console, err);
    if (result == EC_FAILED && request.resume && strcmp(folder, job.job.folder)) ec_fail_more(err, "; the job was begun in '%s'", job.job.folder);
    if (result != EC_OK) goto cleanup;
    result = request.plan_ranks ? ec_render_plan(&job, &cli->console, err) : render(&cli->console, &job, start, err);
cleanup:
    ec_render_job_free(&job);
    free(as_given);
    return result;
}
