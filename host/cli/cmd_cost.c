/* eclat cost SCENE: what buys accuracy cheapest. */
#include <math.h>
#include <stdio.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/cost_request.h"
#include "jobs/defaults.h"
#include "jobs/render_job.h"
#include "cli/stop.h"
#include "jobs/usage.h"
#include "cost/report.h"
#include "image/image.h"

static ec_result check_outputs(const ec_cost_request *request, ec_error *err)
{
    ec_outputs outputs = {0};
    const char *files[] = {request->html, request->json}, *inputs[] = {request->render.environment, request->reference};
    ec_inputs all = {.scene = request->render.scene, .files = inputs, .file_count = 2};
    for (int i = 0; i < 2; i++) {
        if (!files[i] || (i == 1 && files[i][0] == '-' && !files[i][1])) continue;
        ec_output *output = &outputs.file[outputs.count++];
        if (snprintf(output->path, sizeof output->path, "%s", files[i]) >= (int)sizeof output->path)
            return ec_usage(err, "the path '%.*s…' is too long", EC_CUT(files[i], 40));
    }
    ec_result result = ec_outputs_check(&outputs, &all, err);
    ec_inputs_free(&all);
    return result;
}

/* Without --size the study is as large as its reference. */
static ec_result take_size(ec_cost_request *request, ec_error *err)
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

typedef struct cost_view {
    ec_console *console;
    double drawn_at;
} cost_view;

static bool show(void *user, const ec_cost_progress *progress)
{
    cost_view *view = user;
    double now = ec_now(), left = fmax(progress->budget - progress->seconds, 0);
    if (ec_console_wants_progress(view->console) && now - view->drawn_at >= 0.1) {
        char line[256];
        snprintf(line, sizeof line, "%d %%  %d:%02d left  %u of %u  %s",
                 (int)(100 * fmin(progress->seconds / progress->budget, 1)), (int)left / 60, (int)left % 60,
                 progress->done, progress->count, progress->doing);
        ec_console_draw(view->console, line);
        view->drawn_at = now;
    }
    return !ec_stop_requested();
}

static ec_result run_study(ec_cost_study *study, const ec_render_job *job, ec_console *console, ec_error *err)
{
    ec_cl cl = {0};
    cost_view view = {.console = console};
    EC_TRY(ec_cl_open(job->devices, &cl, err));
    study->cl = &cl;
    study->go_on = show;
    study->user = &view;
    ec_stop_catch_signals(ec_console_wants_progress(console));
    ec_console_say(console, "studying %ux%u pixels on %s for %g s", study->options.width, study->options.height,
                   job->devices->name, study->budget);
    ec_result result = ec_cost_run(study, err);
    ec_console_erase(console);
    ec_stop_ignore_file_size();
    ec_cl_close(&cl);
    return result;
}

/* One file that cannot be written must not cost the others. */
static ec_result deliver(const ec_cost_report *report, const ec_cost_request *request, ec_error *err)
{
    ec_result result = EC_OK;
    if (request->html) result = ec_cost_write_html(report, request->html, err);
    if (request->json && ec_cost_write_json(report, request->json, result == EC_OK ? err : NULL) != EC_OK) result = EC_FAILED;
    bool json_on_stdout = request->json && request->json[0] == '-' && !request->json[1];
    if (!json_on_stdout && !request->render.quiet) ec_cost_table(report, isatty(STDOUT_FILENO) == 1, stdout);
    return result;
}

ec_result ec_cmd_cost(ec_cli *cli, int argc, char **argv, ec_error *err)
{
    double start = ec_now();
    ec_cost_request request = {0};
    ec_request asked;
    EC_TRY(ec_cost_request_parse(argc, argv, &request, &asked, err));
    if (ec_cli_leaves(cli, asked)) return EC_OK;
    cli->console.quiet = request.render.quiet;
    ec_log log = ec_console_log(&cli->console);

    const ec_listener listener = {.log = log};
    ec_render_job job = {.request = &request.render, .listener = &listener, .command = cli->line};
    ec_cost_study study = {.start = start, .budget = request.budget, .reference_file = request.reference, .log = &log};
    ec_result result = EC_OK;
    EC_TRY_CLEANUP(check_outputs(&request, err));
    EC_TRY_CLEANUP(take_size(&request, err));
    request.render.default_height = EC_COST_HEIGHT;
    EC_TRY_CLEANUP(ec_render_job_load(&job, err));
    study.scene = job.scene;
    study.options = request.render.options;
    result = run_study(&study, &job, &cli->console, err);
    if (result != EC_OK && !(study.row_count && study.rows[0].state == EC_COST_MEASURED)) goto cleanup;
    const ec_cost_report report = {.study = &study, .command = cli->line, .scene = request.render.scene, .camera = job.camera_text,
                                   .environment = job.environment_text, .device = job.devices, .device_why = job.device_why,
                                   .device_index = job.device_indices[0]};
    if (result == EC_OK) result = deliver(&report, &request, err);
    else if (deliver(&report, &request, NULL) == EC_OK) ec_fail_more(err, "; what was measured before is reported");
cleanup:
    ec_cost_free(&study);
    ec_render_job_free(&job);
    return result;
}
