/* eclat render SCENE: check, load, render, write, tell. */

#include "base/clock.h"
#include "cli/cli.h"
#include "cli/render_job.h"
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
        .device = &job->device,
        .device_why = job->device_why,
        .device_index = job->device_index,
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
    EC_TRY(ec_write_report(&job->request->outputs, &job->film, &report, job->image_sha256, err));
    report.write_seconds = ec_now() - write_start;
    report.total_seconds = ec_now() - start;
    report.peak_memory_bytes = ec_peak_memory_bytes();
    return tell(console, job, &report, err);
}

/* Hours of samples are not to be lost with the device: the picture is written, and the command fails all the same. */
static ec_result render(ec_console *console, ec_render_job *job, double start, ec_error *err)
{
    ec_error why = {0};
    if (ec_render_job_run(job, console, &why) == EC_OK) return deliver(console, job, start, err);
    if (job->film.batch_count == 0) return ec_fail(err, "%s", why.text);
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
    EC_TRY(ec_render_request_parse(argc, argv, &request, &done, err));
    if (done) return EC_OK;
    cli->console.quiet = request.quiet;

    ec_render_job job = {.request = &request, .command = cli->line};
    ec_result result = EC_OK;
    EC_TRY_CLEANUP(ec_render_job_prepare(&job, &cli->console, err));
    EC_TRY_CLEANUP(render(&cli->console, &job, start, err));
cleanup:
    ec_render_job_free(&job);
    return result;
}
