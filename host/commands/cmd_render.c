/* eclat render SCENE */
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "commands/command.h"
#include "jobs/render_plan.h"
#include "jobs/index_page.h"
#include "jobs/scenarios.h"
#include "jobs/series.h"

static int list_rows(ec_option rows[EC_OPTIONS_MAX])
{
    memcpy(rows, ec_render_rows, (size_t)ec_render_row_count * sizeof *rows);
    return ec_render_row_count;
}

static ec_result plan(ec_render_job *job, ec_error *err)
{
    ec_plan plan;
    job->ranks = NULL; /* one process and its device stand for all ranks */
    EC_TRY(ec_render_job_load(job, err));
    EC_TRY(ec_render_plan(job, &plan, err));
    if (job->request->json) return ec_plan_json(&plan, job->listener->to, err);
    ec_plan_text(&plan, job->devices->name, job->listener->to);
    return EC_OK;
}

/* Writes the picture; a slice with its sums. */
static ec_result write_rendered(ec_call *call, ec_outputs *outputs, ec_error *err)
{
    const char *names[EC_OUTPUTS_MAX];
    ec_render_report report = ec_render_job_report(&call->render, names);
    return ec_render_job_write(&call->render, outputs, &report, err);
}

/* Reads the scene and options from the call, and the checkpoint that is resumed. */
static ec_result take_request(ec_call *call, ec_render_request *request, ec_error *err)
{
    if (!request->resume || call->input_count) EC_TRY(ec_call_scene(call, "render", &request->scene, err));
    if (request->resume) return ec_render_job_take_up(&call->render, &call->given, err);
    return ec_render_request_settle(request, ec_render_rows, ec_render_row_count, call->is_given, err);
}

static bool is_series(const ec_call *call, const ec_render_request *r)
{
    bool has_place = false;
    for (int i = 0; i < r->outputs.count; i++) has_place |= ec_entries_has_place(r->outputs.file[i].path);
    return call->input_count > 1 || has_place || r->frames.given || r->orbit || r->scenarios || r->folder || r->sheet || r->shard_count;
}

static ec_result list_entries(const ec_call *call, const ec_render_request *request, ec_entries *entries, ec_error *err)
{
    if (request->scenarios) {
        if (call->input_count) return ec_usage(err, "--scenarios has scenes of its own; leave '%s' out", call->inputs[0]);
        EC_TRY(ec_entries_check(&call->given, err));
        EC_TRY(ec_scenarios_read(request->scenarios, request->folder, &call->given, entries, err));
        if (mkdir(request->folder, 0777) != 0 && errno != EEXIST) return ec_fail(err, "cannot make the folder '%s': %s; choose another with --out", request->folder, strerror(errno));
        return EC_OK;
    }
    for (int i = 0; i == 0 || i < call->input_count; i++)
        if (!call->input_count || !*call->inputs[i]) return ec_usage(err, "render needs a SCENE (.gltf or .glb); see 'eclat render --help'");
    return ec_entries_of_scenes(call->inputs, call->input_count, &call->given, entries, err);
}

/* Writes the page of the pictures that exist, also if some have failed. */
static ec_result write_index(const ec_render_request *request, const ec_entries *entries, ec_result result, ec_error *err)
{
    ec_error why;
    if (!request->scenarios || result == EC_USAGE || ec_index_write(request->scenarios, request->folder, entries, &why) == EC_OK) return result;
    if (result == EC_OK) return ec_fail(err, "%s", why.text);
    ec_fail_more(err, "; and %s", why.text);
    return result;
}

static ec_result run_series(ec_call *call, ec_render_request *request, double start, ec_error *err)
{
    ec_entries entries = {0};
    EC_TRY(ec_render_request_settle(request, ec_render_rows, ec_render_row_count, call->is_given, err));
    ec_result result = list_entries(call, request, &entries, err);
    if (result == EC_OK) {
        result = ec_series_render(call->listener, request, call->ranks, &entries, start, err);
        result = write_index(request, &entries, result, err);
    }
    ec_entries_free(&entries);
    return result;
}

static ec_result run(ec_call *call, ec_error *err)
{
    const double start = ec_now();
    ec_render_request *request = call->request;
    ec_render_job *job = &call->render;
    if (!getcwd(call->folder, sizeof call->folder)) call->folder[0] = 0;
    *job = (ec_render_job){.request = request, .listener = call->listener, .takes_several = true, .ranks = call->ranks, .program = call->program,
                           .command = call->line, .job = {.argc = call->words.count - 1, .argv = call->words.list + 1, .folder = call->folder}};
    call->write = write_rendered;
    if (call->wants_picture && call->input_count > 1)
        return ec_usage(err, "a picture shows one scene; give one, or write files of several by --output with {name}");
    if (is_series(call, request)) return run_series(call, request, start, err);
    EC_TRY(take_request(call, request, err));
    if (request->plan_ranks) return plan(job, err);
    job->in_memory = call->wants_picture && !request->outputs.count;
    job->renders = true;
    ec_result result = job->in_memory ? ec_render_job_load(job, err) : ec_render_job_prepare(job, err);
    if (result == EC_FAILED && request->resume && strcmp(call->folder, job->job.folder))
        ec_fail_more(err, "; the job was begun in '%s'", job->job.folder);
    EC_TRY(result);
    return job->in_memory ? ec_render_job_run(job, err) : ec_render_job_complete(job, start, err);
}

static const eclat_note notes[] = {
    {EC_TITLE_LIMITS, "Ctrl-C", "stop cleanly and write the image so far (exit code 0); a second one aborts"},
    {EC_TITLE_RESUME, "mpirun -n N eclat ...", "render one picture with several processes, one per machine (if eclat was built with MPI)"},
    {0}};

const ec_command ec_cmd_render = {
    .told = {.name = "render", .operands = "SCENE... [options]", .summary = "render scenes to EXR and PNG",
             .intro = "Renders glTF 2.0 scenes (.gltf or .glb) and states the error of each image.",
             .notes = notes},
    .rows = list_rows, .size = sizeof(ec_render_request), .start = ec_render_request_start, .run = run, .is_shared = true,
};
