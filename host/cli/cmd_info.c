/* eclat info SCENE */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "cli/cli.h"
#include "cli/combinations.h"
#include "cli/defaults.h"
#include "cli/options.h"
#include "cli/scene_choice.h"
#include "cli/setters.h"
#include "pipeline/render.h"
#include "report/names.h"
#include "report/scene_report.h"

typedef struct info_request {
    const char *scene, *accel, *device; /* accel: a name, "all", or NULL for none */
    ec_scene_choice choice;
    double grid_density; /* 0: the default */
    bool json, quiet;
} info_request;

#define REQUEST ((info_request *)target)

FLAG_SETTER(json, json)
FLAG_SETTER(quiet, quiet)
TEXT_SETTER(device, device)
CHOICE_SETTER(instancing, choice.instancing, ec_instancing, ec_instancing_names)
SCENE_CHOICE_SETTERS(choice)
SHUTTER_SETTER(choice)
RANGE_SETTER(grid_density, ec_parse_real, EC_GRID_DENSITY_LEAST, EC_GRID_DENSITY_MOST, grid_density)

SETTER(accel)
{
    static const char all[] = "all";
    const char *names[EC_ACCEL_COUNT + 2] = {all};
    uint32_t index = 0;
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) names[a + 1] = ec_accels[a].name;
    EC_TRY(ec_parse_choice(option, value, names, &index, err));
    REQUEST->accel = names[index];
    return EC_OK;
}

static const ec_option options[] = {
    {"accel", 0, true, set_accel},
    {"device", 0, true, set_device},
    {"grid-density", 0, true, set_grid_density},
    {"instancing", 0, true, set_instancing},
    {"json", 0, false, set_json},
    {"quiet", 'q', false, set_quiet},
    SHUTTER_OPTION,
    SCENE_CHOICE_OPTIONS,
};

static ec_result measure(ec_scene_report *report, ec_error *err)
{
    const ec_scene *scene = report->scene;
    ec_bvh bvh = {0};
    EC_TRY(ec_scene_report_count(report, err));
    EC_TRY(ec_bvh_build(scene->positions, scene->indices, ec_scene_flat_count(scene), 0, &bvh, &report->bvh, err));
    ec_bvh_free(&bvh);
    ec_scene lit = *scene;
    if (!report->has_light) { /* what a render does then */
        lit.has_environment = true;
        for (int k = 0; k < 3; k++) lit.environment.constant[k] = 1.0f;
    }
    EC_TRY(ec_scene_estimate(&lit, report->bvh.ref_count + scene->triangle_count - ec_scene_flat_count(scene), &report->device_bytes, &report->effects, err));
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
    EC_TRY(ec_device_find(request->device, device, NULL, NULL, err));
    report->device = device->name;
    EC_TRY(ec_cl_open(device, &cl, err));
    ec_result result = probe_all(&cl, request, report, err);
    ec_cl_close(&cl);
    return result;
}

static ec_result tell(const info_request *request, const ec_log *log, ec_error *err)
{
    ec_scene_report report = {.path = request->scene};
    ec_scene *scene = NULL;
    double start = ec_now();
    EC_TRY(ec_scene_load_choice(request->scene, &request->choice, &scene, log, err));
    report.load_seconds = ec_now() - start;
    report.scene = scene;

    ec_device_info device;
    ec_result result = measure(&report, err);
    if (result == EC_OK && request->accel) result = probe(request, &report, &device, err);
    if (result == EC_OK && request->json)
        result = ec_scene_report_json(&report, stdout, err);
    else if (result == EC_OK)
        ec_scene_report_text(&report, stdout);
    ec_scene_free(scene);
    return result;
}

ec_result ec_cmd_info(ec_cli *cli, int argc, char **argv, ec_error *err)
{
    info_request request = {0};
    int first = 0;
    ec_request asked;
    EC_TRY(ec_options_parse(options, sizeof options / sizeof options[0], &request, argc, argv, &first, NULL, &asked, err));
    if (ec_request_serve(asked, argv[0])) return EC_OK;
    EC_TRY(ec_options_scene(argc, argv, first, &request.scene, err));
    EC_TRY(ec_combinations_check_shutter(&request.choice, err));
    EC_TRY(ec_combinations_check_grid(request.grid_density, request.accel, true, err));
    cli->console.quiet = request.quiet;
    ec_log log = ec_console_log(&cli->console);
    return tell(&request, &log, err);
}
