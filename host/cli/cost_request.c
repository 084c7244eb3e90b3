#include "cli/cost_request.h"

#include <string.h>
#include <strings.h>

#include "cli/cli.h"
#include "jobs/defaults.h"
#include "jobs/options.h"
#include "jobs/scene_choice.h"
#include "jobs/setters.h"

#define REQUEST ((ec_cost_request *)target)

FLAG_SETTER(quiet, render.quiet)
TEXT_SETTER(camera, render.camera)
TEXT_SETTER(device, render.device)
TEXT_SETTER(env, render.environment)
SCENE_CHOICE_SETTERS(render.choice)
TEXT_SETTER(json, json)
TEXT_SETTER(reference, reference)
PARSED_SETTER(budget, ec_parse_seconds, budget)
RANGE_SETTER(seed, ec_parse_whole, 0, UINT64_MAX, render.options.seed)

SETTER(output)
{
    const char *dot = strrchr(value, '.');
    if (!dot || (strcasecmp(dot, ".html") && strcasecmp(dot, ".htm")))
        return ec_usage(err, "-o: '%s' must be named NAME.html; the figures go to a file by --json", value);
    (void)option;
    REQUEST->html = value;
    return EC_OK;
}

SETTER(size)
{
    REQUEST->render.has_size = true;
    return ec_parse_size(option, value, &REQUEST->render.options.width, &REQUEST->render.options.height, err);
}

static const ec_option options[] = {
    {"budget", 0, true, set_budget},
    {"camera", 0, true, set_camera},
    {"device", 0, true, set_device},
    {"env", 0, true, set_env},
    {"json", 0, true, set_json},
    {"output", 'o', true, set_output},
    {"quiet", 'q', false, set_quiet},
    {"reference", 0, true, set_reference},
    {"seed", 0, true, set_seed},
    {"size", 0, true, set_size},
    SCENE_CHOICE_OPTIONS,
};

ec_result ec_cost_request_parse(int argc, char **argv, ec_cost_request *request, bool *done, ec_error *err)
{
    int first = 0;
    ec_request asked;
    request->budget = EC_DEFAULT_BUDGET;
    request->render.options.cutoff = EC_DEFAULT_CUTOFF;
    request->render.env_strength = 1;
    EC_TRY(ec_options_parse(options, sizeof options / sizeof options[0], request, argc, argv, &first, NULL, &asked, err));
    *done = ec_request_serve(asked, argv[0]);
    if (*done) return EC_OK;
    return ec_options_scene(argc, argv, first, &request->render.scene, err);
}
