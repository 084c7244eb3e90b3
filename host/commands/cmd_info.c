/* eclat info SCENE */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "commands/command.h"
#include "device/estimate.h"
#include "gltf/reader.h"
#include "jobs/render_request.h"
#include "report/scene_report.h"
#include "scene/built_in.h"

typedef struct info_request {
    ec_render_request render; /* must be first, for the setters of its options */
    const char *accel;        /* a name, "all", or NULL for none */
    double grid_density;      /* 0: the default */
} info_request;

#define REQUEST info_request

#define NAME(name, lanes, summary) #name,
static const char *const accel_choices[] = {"all", EC_ACCELS(NAME) NULL};

/* Options that mean something else here than in `render`. */
static const ec_option own[] = {
    {.name = "accel", EC_STORED(WORD, accel), .choices = accel_choices,
     .help = "also build this acceleration structure (bvh2, bvh8, grid, kdtree, none, twolevel, or all), trace rays through it, and report what both cost"},
    {.name = "device", .help = "OpenCL device that traces the rays", .otherwise = "as for eclat render"},
    {.name = "grid-density", EC_RANGED(REAL, grid_density, EC_GRID_DENSITY_LEAST, EC_GRID_DENSITY_MOST), .help = "cells per reference with --accel grid or all, as for eclat render", .otherwise = "27"},
    {.name = "json", .help = "print one JSON object instead of text"},
    {.name = "quiet", .help = "print no notes, only the result, warnings and errors"},
};

static void make_own(ec_option *row, const ec_option *mine)
{
    row->group = EC_GROUP_OPTIONS;
    row->uses &= ~(uint32_t)EC_OPTION_BORROWED;
    row->help = mine->help;
    row->otherwise = mine->otherwise;
    if (!mine->kind) return;
    row->set = NULL;
    row->kind = mine->kind;
    row->at = mine->at;
    row->least = mine->least;
    row->most = mine->most;
    row->choices = mine->choices;
}

static int list_rows(ec_option rows[EC_OPTIONS_MAX])
{
    int count = ec_render_rows_for(EC_OPTION_INFO, rows);
    for (int i = 0; i < count; i++) {
        const ec_option *mine = ec_options_find(own, sizeof own / sizeof own[0], rows[i].name);
        if (mine) make_own(&rows[i], mine);
    }
    return count;
}

static ec_result measure(const ec_render_request *request, ec_scene_report *report, ec_error *err)
{
    const ec_scene *scene = report->scene;
    ec_bvh bvh = {0};
    EC_TRY(ec_scene_report_count(report, err));
    EC_TRY(ec_bvh_build(scene->positions, scene->indices, ec_scene_flat_count(scene), 0, &bvh, &report->bvh, err));
    ec_bvh_free(&bvh);
    ec_scene lit = *scene;
    report->takes_studio = !report->has_light && !request->environment && !request->adjusts_env;
    if (report->takes_studio) EC_TRY(ec_scene_set_environment(&lit, EC_STUDIO, NULL, err));
    uint32_t refs = report->bvh.ref_count + scene->triangle_count - ec_scene_flat_count(scene);
    const ec_result result = ec_scene_estimate(&lit, &request->options, refs, &report->device_bytes, &report->effects, err);
    if (report->takes_studio) free(lit.environment.rgb);
    EC_TRY(result);
    report->peak_memory_bytes = ec_peak_memory_bytes();
    return EC_OK;
}

static ec_result probe_all(ec_cl *cl, const info_request *request, ec_scene_report *report, ec_error *err)
{
    bool all = !strcmp(request->accel, "all");
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        ec_accel_report *one = &report->accels[report->accel_count];
        if (!all && strcmp(request->accel, ec_accels[a].name)) continue;
        one->name = ec_accels[a].name;
        if (ec_probe_accel(cl, report->scene, a, (float)request->grid_density, &one->probe, err) != EC_OK) {
            if (!all) return EC_FAILED;
            snprintf(one->refused, sizeof one->refused, "%.255s", err->text);
        }
        report->accel_count++;
    }
    return EC_OK;
}

static ec_result probe(const info_request *request, ec_scene_report *report, ec_device_info *device, ec_error *err)
{
    ec_cl cl;
    EC_TRY(ec_device_find(request->render.device, device, NULL, NULL, err));
    report->device = device->name;
    EC_TRY(ec_cl_open(device, &cl, err));
    ec_result result = probe_all(&cl, request, report, err);
    ec_cl_close(&cl);
    return result;
}

static ec_result look(info_request *request, const ec_listener *listener, ec_error *err)
{
    ec_render_request *render = &request->render;
    ec_scene_report report = {.path = render->scene};
    ec_render_job job = {.request = render, .listener = listener};
    double start = ec_now();
    EC_TRY(ec_scene_load_choice(render->scene, &render->choice, &job.scene, &listener->log, err));
    report.load_seconds = ec_now() - start;
    report.scene = job.scene;

    ec_device_info device;
    ec_result result = render->environment || render->adjusts_env ? ec_render_job_light(&job, err) : EC_OK;
    if (result == EC_OK) result = measure(render, &report, err);
    if (result == EC_OK && request->accel) result = probe(request, &report, &device, err);
    if (result == EC_OK && render->json) result = ec_scene_report_json(&report, listener->to, err);
    else if (result == EC_OK) ec_scene_report_text(&report, listener->to);
    ec_scene_free(job.scene);
    return result;
}

static ec_result run(ec_call *call, ec_error *err)
{
    info_request *request = call->request;
    ec_option rows[EC_OPTIONS_MAX];
    EC_TRY(ec_call_scene(call, "info", &request->render.scene, err));
    EC_TRY(ec_combinations_check_grid(request->grid_density, request->accel, true, err));
    EC_TRY(ec_render_request_settle(&request->render, rows, list_rows(rows), call->is_given, err));
    return look(request, call->listener, err);
}

const ec_command ec_cmd_info = {
    .told = {.name = "info", .operands = "SCENE [options]", .summary = "report what a scene contains and what rendering it takes",
             .intro = "Reports what a glTF scene contains: geometry, materials, lights, cameras, extensions used and unsupported, the effects it calls for and why, the "
                       "memory it takes, and the quality of its bounding-volume hierarchy.",
             .borrows = "Options of eclat render, to report what such a render shows and calls for"},
    .rows = list_rows, .size = sizeof(info_request), .start = ec_render_request_start, .run = run,
};
