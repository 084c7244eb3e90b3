/* eclat view SCENE: a window that shows the render; what it saves is what `eclat render` would have written. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands/command.h"
#include "commands/view_command.h"
#include "jobs/setters.h"
#include "jobs/write_report.h"
#include "pack/scene_view.h"
#include "report/names.h"
#include "report/scene_report.h"
#include "view/view.h"

#define VIEW_HEIGHT 600

typedef struct view_job {
    ec_render_request render; /* first: the setters of its options are used */
    const char *against, *script;
    bool stats;
    ec_kept_options kept;     /* for the command that repeats a picture */
    const ec_listener *listener;
    ec_device_info device;
    uint32_t device_index;
    const char *device_why;
    char environment[256];
    double load_seconds;
    uint32_t camera;          /* of the options, once loaded */
    ec_viewpoint viewpoint;   /* its */
    int saved;
    ec_error unsaved;         /* of the last save, if it failed: who looked elsewhere, or is a script, is told at the end */
} view_job;

#define REQUEST ((view_job *)target)
TEXT_SETTER(against, against)
TEXT_SETTER(script, script)
FLAG_SETTER(stats, stats)

static ec_result refuse(void *target, const char *option, const char *value, ec_error *err)
{
    (void)target, (void)value;
    return ec_usage(err, "--%s is for 'eclat render': %s", option, ec_render_row(option)->not_in_window);
}

static ec_result set_and_keep(void *target, const char *option, const char *value, ec_error *err)
{
    view_job *job = target;
    const ec_option *row = ec_render_row(option);
    EC_TRY(row->set(&job->render, option, value, err));
    if (!(row->uses & EC_OPTION_WINDOW)) ec_kept_options_add(&job->kept, row->name, value);
    return EC_OK;
}

static const ec_option own[] = {
    {.name = "against", .metavar = "FILE.exr", .set = set_against, .help = "picture to compare with the rendered one (V and Tab)"},
    {.name = "script", .metavar = "FILE", .set = set_script,
     .help = "move the camera and press keys as a script says, then close; the script orbit turns once around. Lines: turn YAW PITCH SECONDS (degrees), "
             "pan RIGHT UP SECONDS (picture heights), dolly FACTOR SECONDS, wait SECONDS, settle (until the limit is met), key NAME (e, E, 1, Tab, Save, ...; "
             "after X digits switch effects), quit. 0 SECONDS means at once"},
    {.name = "stats", .set = set_stats, .help = "report at the end when there was first light, and how long frames took while the camera moved"},
};

static int list_rows(ec_option rows[EC_OPTIONS_MAX])
{
    int count = 0;
    for (; count < (int)(sizeof own / sizeof own[0]); count++) rows[count] = own[count];
    for (int i = 0; i < ec_render_row_count && count < EC_OPTIONS_MAX; i++) {
        rows[count] = ec_render_rows[i];
        rows[count].uses |= EC_OPTION_BORROWED;
        rows[count++].set = ec_render_rows[i].not_in_window ? refuse : set_and_keep;
    }
    ec_option *size = &rows[ec_options_find(rows, count, "size") - rows];
    size->group = EC_GROUP_OPTIONS;
    size->uses &= ~(uint32_t)EC_OPTION_BORROWED;
    size->help = "size of the window when it opens, in pixels";
    size->otherwise = EC_TEXT(VIEW_HEIGHT) " high";
    return count;
}

/* The environment stays unturned: the window turns it. */
static ec_result load(void *user, ec_scene **scene, ec_render_options *options, ec_error *err)
{
    view_job *job = user;
    ec_render_request request = job->render;
    ec_render_job render = {.request = &request, .listener = job->listener};
    request.env_degrees = 0;
    ec_result result = ec_render_job_load(&render, err);
    if (result != EC_OK) {
        ec_render_job_free(&render);
        return result;
    }
    *scene = render.scene;
    *options = request.options;
    job->camera = request.options.camera;
    job->viewpoint = render.viewpoint;
    job->load_seconds = render.load_seconds;
    snprintf(job->environment, sizeof job->environment, "%s", render.environment_text);
    return EC_OK;
}

/* NAME.exr, NAME-2.exr …: a later picture does not take the place of an earlier one of this window. */
static void number_outputs(ec_outputs *outputs, int number)
{
    for (int i = 0; i < outputs->count && number > 1; i++) {
        char *path = outputs->file[i].path, *dot = strrchr(path, '.'), numbered[PATH_MAX];
        if (snprintf(numbered, sizeof numbered, "%.*s-%d%s", (int)(dot - path), path, number, dot) < (int)sizeof numbered)
            memcpy(path, numbered, sizeof numbered);
    }
}

static ec_viewpoint viewpoint_of(const view_job *job, const ec_view_shot *shot)
{
    ec_viewpoint v = shot->viewpoint;
    const ec_camera *camera = &shot->scene->cameras[shot->options->camera];
    if (!shot->moved && shot->options->camera == job->camera) return job->viewpoint;
    if (!shot->moved) ec_camera_viewpoint(camera, shot->scene->center, ec_camera_reach(shot->scene, camera), &v);
    return v;
}

static ec_result check_outputs(const view_job *job, const ec_outputs *outputs, ec_error *err)
{
    ec_inputs inputs = {.scene = job->render.scene, .files = &job->render.environment, .file_count = 1};
    ec_result result = ec_outputs_check(outputs, &inputs, err);
    ec_inputs_free(&inputs);
    return result;
}

static ec_result write_shot(view_job *job, const ec_view_shot *shot, char *told, size_t size, ec_error *err)
{
    ec_outputs outputs = job->render.outputs;
    char sha256[EC_HASH_SIZE], camera[256] = "of the preview window", environment[320];
    if (outputs.count == 0) EC_TRY(ec_outputs_add_default(&outputs, job->render.scene, err));
    number_outputs(&outputs, job->saved + 1);
    EC_TRY(check_outputs(job, &outputs, err));
    char *command = ec_view_command(&job->render, &job->kept, job->camera, shot, &outputs);
    if (!command) return ec_fail(err, "out of memory for a command line");
    if (!shot->moved) ec_camera_describe(shot->scene, shot->options->camera, camera, sizeof camera);
    snprintf(environment, sizeof environment, "%s", job->environment);
    if (shot->env_degrees != 0)
        snprintf(environment, sizeof environment, "%s, turned by %g degrees", job->environment, shot->env_degrees);
    ec_render_report report = {
        .command = command, .scene = job->render.scene, .camera = camera, .viewpoint = viewpoint_of(job, shot), .environment = environment,
        .options = shot->options, .stats = shot->stats, .device = &job->device, .device_why = job->device_why,
        .device_index = &job->device_index, .exposure = shot->exposure, .tonemap = shot->tonemap,
        .mean_luminance = ec_film_estimate_error(shot->film).mean_luminance, .replicates = ec_film_replicates(shot->film),
        .load_seconds = job->load_seconds,
    };
    ec_result result = ec_write_report(&outputs, shot->film, NULL, &report, sha256, err);
    if (result == EC_OK) {
        int used = snprintf(told, size, "saved");
        for (int i = 0; i < outputs.count && used > 0 && (size_t)used < size; i++)
            used += snprintf(told + used, size - (size_t)used, "%s %s", i ? "," : "", outputs.file[i].path);
        if (used > 0 && (size_t)used < size) snprintf(told + used, size - (size_t)used, "; again by: %s", command);
        fprintf(job->listener->to, "%s\n", command);
        job->saved++;
        result = job->listener->report(job->listener->user, err);
    }
    free(command);
    return result;
}

static ec_result save(void *user, const ec_view_shot *shot, char *told, size_t size, ec_error *err)
{
    view_job *job = user;
    job->listener->begin(job->listener->user, NULL, false);
    ec_result result = write_shot(job, shot, told, size, err);
    job->unsaved = result == EC_OK ? (ec_error){.kind = EC_ERROR_OTHER} : *err;
    return result;
}

static ec_result run(ec_call *call, ec_error *err)
{
    view_job *job = call->request;
    ec_option rows[EC_OPTIONS_MAX];
    const ec_view_module *window;
    job->listener = call->listener;
    EC_TRY(ec_call_scene(call, "view", &job->render.scene, err));
    job->render.default_height = VIEW_HEIGHT;
    EC_TRY(ec_render_request_settle(&job->render, rows, list_rows(rows), call->is_given, err));
    EC_TRY(ec_view_load(&window, err));
    EC_TRY(check_outputs(job, &job->render.outputs, err));
    EC_TRY(ec_device_find(job->render.device, &job->device, &job->device_index, &job->device_why, err));
    if (job->against) {
        uint32_t width, height;
        float *rgb;
        EC_TRY(ec_image_read_rgb(job->against, &width, &height, &rgb, err));
        free(rgb);
    }
    const ec_view_request request = {
        .device = job->device, .options = job->render.options, .env_degrees = job->render.env_degrees, .exposure = job->render.exposure,
        .tonemap = job->render.tonemap, .scene = job->render.scene, .environment = job->render.environment, .against = job->against,
        .script = job->script, .stats = job->stats, .user = job, .load = load, .save = save, .stop = call->stop,
    };
    call->listener->begin(call->listener->user, NULL, false);
    EC_TRY(window->run(&request, err));
    return *job->unsaved.text ? ec_fail(err, "%s", job->unsaved.text) : EC_OK;
}

const ec_command ec_cmd_view = {
    .told = {.name = "view", .operands = "SCENE [options]", .summary = "show a scene in a window while it renders",
             .intro = "Opens a window that shows a glTF 2.0 scene as it renders: rasterised at once, then path traced, coarsely while the camera moves and ever finer once it "
                       "rests. S saves what eclat render would have written and prints the command that renders the same picture again, bit for bit. When a file of the "
                       "scene changes, it is loaded again.",
             .lacks = "All options of eclat render, except",
             .closing = "Limits (--spp, --error, --time) count from the moment the camera comes to rest; when one is reached, the window sleeps."},
    .rows = list_rows, .size = sizeof(view_job), .start = ec_render_request_start, .run = run, .is_interactive = true,
};
