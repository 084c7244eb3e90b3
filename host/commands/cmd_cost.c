/* eclat cost SCENE: measures what buys accuracy cheapest. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/clock.h"
#include "base/text.h"
#include "commands/command.h"
#include "cost/report.h"
#include "image/image.h"
#include "report/json.h"

#define COST_UNIT "16" /* EC_COST_UNIT, which is an enumerator and cannot be used in a text */

typedef struct cost_request {
    ec_render_request render;  /* must be first, for the setters of its options. Uses scene, camera, environment, device, size and seed; no outputs */
    double budget;             /* seconds */
    const char *html, *json;   /* paths; NULL: none; json may be "-" */
    const char *reference;     /* path or NULL */
} cost_request;

#define REQUEST cost_request

static ec_result set_output(void *target, const char *option, const char *value, ec_error *err)
{
    const char *dot = strrchr(value, '.');
    if (!dot || (strcasecmp(dot, ".html") && strcasecmp(dot, ".htm")))
        return ec_usage(err, "-o: '%s' must be named NAME.html; the figures go to a file by --json", value);
    (void)option;
    ((cost_request *)target)->html = value;
    return EC_OK;
}

static const ec_option own[] = {
    {.name = "budget", .metavar = "S", EC_STORED(SECONDS, budget), .group = EC_GROUP_STUDY,
     .help = "time for the whole study, the reference included; 40s, 2m and 1h are understood too. A kernel that is being compiled when the time is up is "
             "finished. Compiled kernels are kept for the next study",
     .otherwise = "2m"},
    {.name = "json", .metavar = "FILE", EC_STORED(TEXT, json), .group = EC_GROUP_RESULTS, .help = "write every figure to FILE; - prints them instead of the table"},
    {.name = "output", .letter = 'o', .metavar = "FILE", .set = set_output, .group = EC_GROUP_RESULTS,
     .help = "write FILE.html, one page with charts, tables and pictures that opens without a network"},
    {.name = "quiet", .letter = 'q', EC_STORED(FLAG, render.quiet), .group = EC_GROUP_MESSAGES, .help = "print only warnings and errors"},
    {.name = "reference", .metavar = "FILE", EC_STORED(TEXT, reference), .group = EC_GROUP_STUDY,
     .help = "compare with this .exr; its standard errors, if it has any, count as its uncertainty",
     .otherwise = "a picture rendered first, for a third of the budget"},
    {.name = "seed", .metavar = "N", EC_STORED(U64, render.options.seed), .group = EC_GROUP_STUDY, .help = "another N gives another, independent study", .otherwise = "0"},
    {.name = "size", .metavar = "WxH", EC_STORED(SIZE, render.options.width), EC_TOLD(render.has_size), .group = EC_GROUP_PICTURE, .help = "width and height in pixels",
     .otherwise = "the reference's; else " EC_TEXT(EC_COST_HEIGHT) " high, and as wide as the camera's aspect ratio requires; half or a quarter of that where the budget is short"},
};

static int list_rows(ec_option rows[EC_OPTIONS_MAX])
{
    int count = ec_render_rows_for(EC_OPTION_COST, rows);
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) rows[count++] = own[i];
    return count;
}

static bool is_told(const char *json) { return json && !strcmp(json, "-"); }

static ec_result check_outputs(const cost_request *request, ec_error *err)
{
    ec_outputs outputs = {0};
    const char *files[] = {request->html, request->json}, *inputs[] = {request->render.environment, request->reference};
    ec_inputs all = {.scene = request->render.scene, .files = inputs, .file_count = 2};
    for (int i = 0; i < 2; i++) {
        if (!files[i] || (i == 1 && is_told(files[i]))) continue;
        ec_output *output = &outputs.file[outputs.count++];
        if (snprintf(output->path, sizeof output->path, "%s", files[i]) >= (int)sizeof output->path)
            return ec_usage(err, "the path '%.*s…' is too long", EC_CUT(files[i], 40));
    }
    ec_result result = ec_outputs_check(&outputs, &all, err);
    ec_inputs_free(&all);
    return result;
}

/* Takes the size of the reference, if --size is not given. */
static ec_result take_size(cost_request *request, ec_error *err)
{
    ec_exr exr = {0};
    if (!request->reference || request->render.has_size) return EC_OK;
    EC_TRY(ec_exr_read(request->reference, &exr, err));
    request->render.options.width = exr.width;
    request->render.options.height = exr.height;
    request->render.has_size = true;
    ec_exr_free(&exr);
    return EC_OK;
}

static bool show(void *user, const ec_cost_progress *progress)
{
    const ec_listener *listener = user;
    const ec_step step = {.doing = progress->doing, .done = progress->done, .count = progress->count, .seconds = progress->seconds,
                          .fraction = fmin(progress->seconds / progress->budget, 1), .seconds_left = fmax(progress->budget - progress->seconds, 0)};
    return listener->step(listener->user, &step);
}

static ec_result run_study(ec_cost_study *study, const ec_render_job *job, ec_error *err)
{
    ec_cl cl = {0};
    EC_TRY(ec_cl_open(job->devices, &cl, err));
    study->cl = &cl;
    study->go_on = show;
    study->user = (void *)(uintptr_t)job->listener;
    job->listener->begin(job->listener->user, NULL, true);
    ec_say(study->log, "studying %ux%u pixels on %s for %g s", study->options.width, study->options.height, job->devices->name, study->budget);
    ec_result result = ec_cost_run(study, err);
    job->listener->end(job->listener->user);
    ec_cl_close(&cl);
    return result;
}

/* Writes the reports; one that cannot be written does not stop the others. */
static ec_result deliver(const ec_cost_report *report, const cost_request *request, const ec_listener *listener, ec_error *err)
{
    const bool is_json = is_told(request->json);
    ec_result result = request->html ? ec_cost_write_html(report, request->html, err) : EC_OK;
    if (request->json && !is_json && ec_cost_write_json(report, request->json, result == EC_OK ? err : NULL) != EC_OK) result = EC_FAILED;
    if (is_json && ec_json_print(ec_cost_json(report), listener->to, result == EC_OK ? err : NULL) != EC_OK) result = EC_FAILED;
    if (!is_json && !request->render.quiet) ec_cost_table(report, listener->bold, listener->to);
    return result;
}

static void start(void *target)
{
    ec_render_request_start(target);
    ((cost_request *)target)->budget = EC_DEFAULT_BUDGET;
}

static ec_result run(ec_call *call, ec_error *err)
{
    cost_request *request = call->request;
    const ec_listener *listener = call->listener;
    ec_render_job job = {.request = &request->render, .listener = listener, .command = call->line};
    ec_cost_study study = {.start = ec_now(), .budget = request->budget, .reference_file = request->reference, .log = &listener->log};
    ec_result result;
    EC_TRY_CLEANUP(ec_call_scene(call, "cost", &request->render.scene, err));
    EC_TRY_CLEANUP(check_outputs(request, err));
    EC_TRY_CLEANUP(take_size(request, err));
    request->render.default_height = EC_COST_HEIGHT;
    EC_TRY_CLEANUP(ec_render_job_load(&job, err));
    study.scene = job.scene;
    study.options = request->render.options;
    study.may_shrink = !request->render.has_size;
    result = run_study(&study, &job, err);
    if (result != EC_OK && !(study.row_count && study.rows[0].state == EC_COST_MEASURED)) goto cleanup;
    const ec_cost_report report = {.study = &study, .command = call->line, .scene = request->render.scene, .camera = job.camera_text,
                                   .environment = job.environment_text, .device = job.devices, .device_why = job.device_why,
                                   .device_index = job.device_indices[0]};
    if (result == EC_OK) result = deliver(&report, request, listener, err);
    else if (deliver(&report, request, listener, NULL) == EC_OK) ec_fail_more(err, "; what was measured before is reported");
cleanup:
    ec_cost_free(&study);
    ec_render_job_free(&job);
    return result;
}

static const eclat_note notes[] = {
    {"Study", "Ctrl-C", "stop cleanly and report what is known so far (exit code 0); a second one aborts"},
    {"Columns", "time", "time of a sample as a multiple of the first row's, set-up excluded; the two are rendered in turns"},
    {"Columns", "variance", "variance of one sample, relative to the squared mean luminance, in pictures of " COST_UNIT " samples per pixel"},
    {"Columns", "bias",
     "the error that remains with unlimited samples. floor: it is certain; <: an upper bound; fades: it falls with more samples, as a denoiser's does; same bits: the picture equals the first row's; lacks: an "
     "unbiased rung that has not met rare light yet, so that its other figures are too good"},
    {"Columns", "to 5 % ...", "time until the error is below this. ~: extrapolated; ?: unknown; never: this is below the floor"},
    {"Columns", "best", "the first row, unless another one is better by more than three standard errors. Page and JSON have slope, efficiency and memory too"},
    {0}};

const ec_command ec_cmd_cost = {
    .told = {.name = "cost", .operands = "SCENE [options]", .summary = "measure which technique buys accuracy cheapest on a scene",
             .intro = "Renders a glTF 2.0 scene with the defaults of eclat render, then again with one thing changed or left out: integrator, sampling, random numbers, "
                       "roulette, a denoiser, multiple scattering at rough surfaces, a clamp, arithmetic, each effect of the scene, acceleration structure, lanes. For each of these "
                       "rungs it prints time per sample, noise, bias against a reference, and the time to a given error.",
             .closing = "The best figures are bold, or have an asterisk where the output is not a terminal; rungs that leave something out do not compete.",
             .notes = notes},
    .rows = list_rows, .size = sizeof(cost_request), .start = start, .run = run,
};
