/* eclat info SCENE */
#include <stdio.h>

#include "accel/bvh.h"
#include "base/clock.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "pipeline/render.h"
#include "report/scene_report.h"

typedef struct info_request {
    const char *scene;
    bool json, quiet;
} info_request;

static ec_result set_json(void *target, const char *option, const char *value, ec_error *err)
{
    (void)option, (void)value, (void)err;
    ((info_request *)target)->json = true;
    return EC_OK;
}

static ec_result set_quiet(void *target, const char *option, const char *value, ec_error *err)
{
    (void)option, (void)value, (void)err;
    ((info_request *)target)->quiet = true;
    return EC_OK;
}

static const ec_option options[] = {{"json", 0, false, set_json}, {"quiet", 'q', false, set_quiet}};

static ec_result measure(ec_scene_report *report, char *effects, size_t effects_size, ec_error *err)
{
    const ec_scene *scene = report->scene;
    ec_bvh bvh = {0};
    ec_scene_report_count(report);
    EC_TRY(ec_bvh_build(scene->positions, scene->indices, scene->triangle_count, 0, &bvh, &report->bvh, err));
    ec_bvh_free(&bvh);
    EC_TRY(ec_scene_estimate(scene, report->bvh.ref_count, &report->device_bytes, effects, effects_size, err));
    report->peak_memory_bytes = ec_peak_memory_bytes();
    return EC_OK;
}

static ec_result tell(const info_request *request, const ec_log *log, ec_error *err)
{
    char effects[512] = "";
    ec_scene_report report = {.path = request->scene, .effects = effects};
    ec_scene *scene = NULL;
    double start = ec_now();
    EC_TRY(ec_scene_load(request->scene, &scene, log, err));
    report.load_seconds = ec_now() - start;
    report.scene = scene;

    ec_result result = measure(&report, effects, sizeof effects, err);
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
    EC_TRY(ec_options_parse(options, sizeof options / sizeof options[0], &request, argc, argv, &first, &asked, err));
    if (ec_request_serve(asked, argv[0])) return EC_OK;
    EC_TRY(ec_options_scene(argc, argv, first, &request.scene, err));
    cli->console.quiet = request.quiet;
    ec_log log = ec_console_log(&cli->console);
    return tell(&request, &log, err);
}
