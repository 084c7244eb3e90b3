#include "jobs/render_request.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "accel/accel.h"
#include "jobs/combinations.h"
#include "jobs/defaults.h"
#include "jobs/scene_choice.h"
#include "jobs/setters.h"
#include "pack/scene_view.h"
#include "ranks/plan.h"
#include "report/names.h"

#define REQUEST ((ec_render_request *)target)

SETTER(accel)
{
    uint32_t index = 0;
    EC_TRY(ec_parse_choice(option, value, ec_accel_names, &index, err));
    REQUEST->options.accel = ec_accel_names[index];
    return EC_OK;
}

FLAG_SETTER(json, json)
FLAG_SETTER(overwrite, overwrite)
FLAG_SETTER(quiet, quiet)
FLAG_SETTER(verbose, verbose)
TEXT_SETTER(camera, camera)
TEXT_SETTER(resume, resume)
TEXT_SETTER(device, device)
TEXT_SETTER(env, environment)
CHOICE_SETTER(instancing, choice.instancing, ec_instancing, ec_instancing_names)
SCENE_CHOICE_SETTERS(choice)
SHUTTER_SETTER(choice)
CHOICE_SETTER(filter, options.filter, ec_pixel_filter, ec_filter_names)
CHOICE_SETTER(integrator, options.integrator, ec_integrator, ec_integrator_names)
CHOICE_SETTER(light_choice, options.light_choice, ec_light_choice, ec_light_choice_names)
CHOICE_SETTER(sample, options.sample, ec_sample, ec_sample_names)
CHOICE_SETTER(sampler, options.sampler, ec_sampler_type, ec_sampler_names)
CHOICE_SETTER(scattering, options.scattering, ec_scattering, ec_scattering_names)
CHOICE_SETTER(terminator, options.terminator, ec_terminator, ec_terminator_names)
CHOICE_SETTER(tonemap, tonemap, ec_tonemap, ec_tonemap_names)
PARSED_SETTER(error, ec_parse_percent, options.error_target)
PARSED_SETTER(lanes, ec_parse_lanes, options.lanes)
PARSED_SETTER(every, ec_parse_seconds, every)
PARSED_SETTER(memory, ec_parse_bytes, options.memory)
PARSED_SETTER(time, ec_parse_seconds, options.time_limit)
RANGE_SETTER(clamp, ec_parse_real, EC_CLAMP_LEAST, EC_CLAMP_MOST, options.clamp)
RANGE_SETTER(cutoff, ec_parse_real, 0, 1, options.cutoff)
SETTER(env_rotate)
{
    REQUEST->adjusts_env = true;
    return ec_parse_real(option, value, -36000, 36000, &REQUEST->env_degrees, err);
}
SETTER(env_strength)
{
    REQUEST->adjusts_env = true;
    return ec_parse_real(option, value, 0, 1e30, &REQUEST->env_strength, err);
}
SETTER(eye)
{
    REQUEST->look.has_eye = true;
    return ec_parse_triple(option, value, REQUEST->look.to.eye, err);
}
SETTER(look_at)
{
    REQUEST->look.has_target = true;
    return ec_parse_triple(option, value, REQUEST->look.to.target, err);
}
SETTER(up)
{
    const double *up = REQUEST->look.to.up;
    REQUEST->look.has_up = true;
    EC_TRY(ec_parse_triple(option, value, REQUEST->look.to.up, err));
    if (up[0] == 0 && up[1] == 0 && up[2] == 0) return ec_usage(err, "--%s: '%s' is no direction", option, value);
    return EC_OK;
}
SETTER(fov)
{
    REQUEST->look.has_lens = true;
    REQUEST->look.to.tall = 0;
    return ec_parse_real(option, value, EC_FOV_LEAST, EC_FOV_MOST, &REQUEST->look.to.fov, err);
}
SETTER(parallel)
{
    REQUEST->look.has_lens = true;
    REQUEST->look.to.fov = 0;
    return ec_parse_real(option, value, EC_FOCUS_LEAST, EC_FOCUS_MOST, &REQUEST->look.to.tall, err);
}
RANGE_SETTER(filter_width, ec_parse_real, EC_FILTER_WIDTH_LEAST, EC_FILTER_WIDTH_MOST, options.filter_width)
RANGE_SETTER(fps, ec_parse_real, EC_FPS_LEAST, EC_FPS_MOST, frames.fps)
RANGE_SETTER(focus, ec_parse_real, EC_FOCUS_LEAST, EC_FOCUS_MOST, options.focus)
RANGE_SETTER(fstop, ec_parse_real, EC_FSTOP_LEAST, EC_FSTOP_MOST, options.fstop)
RANGE_SETTER(exposure, ec_parse_real, -EC_EXPOSURE_MOST, EC_EXPOSURE_MOST, exposure)
RANGE_SETTER(spp, ec_parse_u32, 1, EC_MAX_SPP, options.spp)
RANGE_SETTER(wave, ec_parse_u32, 1, 1u << 28, options.wave)

SETTER(frames) { return ec_frame_range_parse(option, value, &REQUEST->frames, err); }

SETTER(grid_density)
{
    double density = 0;
    EC_TRY(ec_parse_real(option, value, EC_GRID_DENSITY_LEAST, EC_GRID_DENSITY_MOST, &density, err));
    REQUEST->options.grid_density = (float)density;
    return EC_OK;
}

SETTER(max_depth)
{
    if (!strcmp(value, "inf")) {
        REQUEST->options.max_depth = 0;
        REQUEST->endless = true;
        return EC_OK;
    }
    ec_result result = ec_parse_u32(option, value, 1, EC_MAX_DEPTH, &REQUEST->options.max_depth, err);
    if (result != EC_OK)
        ec_usage(err, "--%s: '%s' is neither a whole number from 1 to %d nor inf", option, value, EC_MAX_DEPTH);
    return result;
}

SETTER(output)
{
    (void)option;
    return ec_outputs_add(&REQUEST->outputs, value, err);
}

SETTER(rr)
{
    double survival = !strcmp(value, "off");
    if (survival == 0 && strcmp(value, "auto") &&
        (ec_parse_real(option, value, 0, 1, &survival, err) != EC_OK || survival == 0))
        return ec_usage(err, "--%s: '%s' is neither a probability over 0 and up to 1 nor auto nor off", option, value);
    REQUEST->options.survival = survival;
    return EC_OK;
}

SETTER(effects)
{
    static const char *const names[] = {"needed", "all", NULL};
    uint32_t index = 0;
    EC_TRY(ec_parse_choice(option, value, names, &index, err));
    REQUEST->options.all_effects = index == 1;
    return EC_OK;
}

/* May be repeated. */
SETTER(without)
{
    char names[EC_EFFECT_NAMES];
    for (uint32_t i = 0; i < ec_feature_count; i++) {
        if (!(ec_effects_optional & ec_features[i].bit) || strcmp(value, ec_features[i].name)) continue;
        REQUEST->options.without |= ec_features[i].bit;
        return EC_OK;
    }
    ec_feature_names(ec_effects_optional, names, sizeof names);
    return ec_usage(err, "--%s: '%s' is not one of the effects that can be left out: %s", option, value, names);
}

/* A checkpoint is an EXR, and named so, since viewers go by that. */
SETTER(checkpoint)
{
    size_t size = strlen(value);
    if (size <= 4 || value[size - 5] == '/' || strcasecmp(value + size - 4, ".exr"))
        return ec_usage(err, "--%s: '%s' must be named NAME.exr", option, value);
    REQUEST->checkpoint = value;
    return EC_OK;
}

SETTER(seed)
{
    REQUEST->seed_is_frame = !strcmp(value, "frame");
    return REQUEST->seed_is_frame ? EC_OK : ec_parse_whole(option, value, 0, UINT64_MAX, &REQUEST->options.seed, err);
}

/* RANKS[,GBIT[,MICROSECONDS]] */
SETTER(plan)
{
    char text[64], *rest = text;
    REQUEST->plan_gbit = EC_PLAN_GBIT;
    REQUEST->plan_microseconds = EC_PLAN_MICROSECONDS;
    if (snprintf(text, sizeof text, "%s", value) >= (int)sizeof text) return ec_usage(err, "--%s: '%s' is too long", option, value);
    EC_TRY(ec_parse_u32(option, strsep(&rest, ","), 1, EC_PLAN_RANKS_MOST, &REQUEST->plan_ranks, err));
    if (rest) EC_TRY(ec_parse_real(option, strsep(&rest, ","), 0.001, 1e6, &REQUEST->plan_gbit, err));
    if (rest) EC_TRY(ec_parse_real(option, rest, 0, 1e6, &REQUEST->plan_microseconds, err));
    return EC_OK;
}

SETTER(samples)
{
    char first[24];
    const char *colon = strchr(value, ':');
    REQUEST->has_slice = true;
    if (!colon || colon == value || (size_t)(colon - value) >= sizeof first || !colon[1])
        return ec_usage(err, "--%s: '%s' is not A:B, two numbers of samples a pixel as in 128:256", option, value);
    snprintf(first, sizeof first, "%.*s", (int)(colon - value), value);
    EC_TRY(ec_parse_u32(option, first, 0, EC_MAX_SPP, &REQUEST->slice_first, err));
    EC_TRY(ec_parse_u32(option, colon + 1, 1, EC_MAX_SPP, &REQUEST->slice_end, err));
    if (REQUEST->slice_first < REQUEST->slice_end) return EC_OK;
    return ec_usage(err, "--%s: %s holds no samples; the second number must be the larger", option, value);
}

SETTER(size)
{
    REQUEST->has_size = true;
    return ec_parse_size(option, value, &REQUEST->options.width, &REQUEST->options.height, err);
}

/* Alone it means on. */
SETTER(adaptive)
{
    static const char *const names[] = {"auto", "on", "off", NULL};
    uint32_t index = EC_ADAPTIVE_ON;
    if (value) EC_TRY(ec_parse_choice(option, value, names, &index, err));
    REQUEST->adaptive = (ec_adaptive)index;
    return EC_OK;
}
RANGE_SETTER(replicates, ec_parse_u32, 1, EC_REPLICATES_MOST, options.replicates)

const ec_option ec_render_rows[] = {
    {"accel", 0, true, set_accel},
    {"adaptive", 0, EC_VALUE_OPTIONAL, set_adaptive},
    {"camera", 0, true, set_camera},
    {"checkpoint", 0, true, set_checkpoint},
    {"clamp", 0, true, set_clamp},
    {"cutoff", 0, true, set_cutoff},
    {"device", 0, true, set_device},
    {"effects", 0, true, set_effects},
    {"env", 0, true, set_env},
    {"env-rotate", 0, true, set_env_rotate},
    {"env-strength", 0, true, set_env_strength},
    {"error", 0, true, set_error},
    {"every", 0, true, set_every},
    {"exposure", 0, true, set_exposure},
    {"eye", 0, true, set_eye},
    {"filter", 0, true, set_filter},
    {"filter-width", 0, true, set_filter_width},
    {"focus", 0, true, set_focus},
    {"fov", 0, true, set_fov},
    {"fps", 0, true, set_fps},
    {"frames", 0, true, set_frames},
    {"fstop", 0, true, set_fstop},
    {"grid-density", 0, true, set_grid_density},
    {"instancing", 0, true, set_instancing},
    {"integrator", 0, true, set_integrator},
    {"json", 0, false, set_json},
    {"lanes", 0, true, set_lanes},
    {"light-choice", 0, true, set_light_choice},
    {"look-at", 0, true, set_look_at},
    {"max-depth", 0, true, set_max_depth},
    {"memory", 0, true, set_memory},
    {"output", 'o', true, set_output},
    {"overwrite", 0, false, set_overwrite},
    {"parallel", 0, true, set_parallel},
    {"plan", 0, true, set_plan},
    {"quiet", 'q', false, set_quiet},
    {"resume", 0, true, set_resume},
    {"replicates", 0, true, set_replicates},
    {"rr", 0, true, set_rr},
    {"sample", 0, true, set_sample},
    {"sampler", 0, true, set_sampler},
    {"samples", 0, true, set_samples},
    {"scattering", 0, true, set_scattering},
    {"seed", 0, true, set_seed},
    {"size", 0, true, set_size},
    {"spp", 0, true, set_spp},
    {"terminator", 0, true, set_terminator},
    {"time", 0, true, set_time},
    {"tonemap", 0, true, set_tonemap},
    {"up", 0, true, set_up},
    {"verbose", 'v', false, set_verbose},
    {"wave", 0, true, set_wave},
    {"without", 0, true, set_without},
    SHUTTER_OPTION,
    SCENE_CHOICE_OPTIONS,
};
_Static_assert(sizeof ec_render_rows / sizeof ec_render_rows[0] <= EC_OPTIONS_MAX, "a larger EC_OPTIONS_MAX");
const int ec_render_row_count = sizeof ec_render_rows / sizeof ec_render_rows[0];

void ec_render_request_start(ec_render_request *request)
{
    *request = (ec_render_request){.env_strength = 1, .options.cutoff = EC_DEFAULT_CUTOFF};
}

ec_result ec_render_request_parse(int argc, char **argv, ec_render_request *request, ec_request *asked, ec_error *err)
{
    int first = 0;
    bool given[EC_OPTIONS_MAX] = {false};
    ec_render_request_start(request);
    EC_TRY(ec_options_parse(ec_render_rows, ec_render_row_count, request, argc, argv, &first, given, asked, err));
    if (*asked != EC_REQUEST_RUN || (request->resume && first == argc)) return EC_OK;
    EC_TRY(ec_options_scene(argc, argv, first, &request->scene, err));
    return request->resume ? EC_OK : ec_render_request_settle(request, ec_render_rows, ec_render_row_count, given, err);
}

ec_result ec_render_request_resume(const ec_job *job, int argc, char **argv, ec_render_request *request, ec_error *err)
{
    int first = 0;
    bool given[EC_OPTIONS_MAX] = {false};
    const ec_render_request now = *request;
    ec_request asked;
    char **before = malloc(((size_t)job->argc + 1) * sizeof *before); /* getopt changes their order */
    if (!before) return ec_fail(err, "out of memory");
    memcpy(before, job->argv, (size_t)job->argc * sizeof *before);
    before[job->argc] = NULL;
    ec_render_request_start(request);
    ec_result result =
        ec_options_parse(ec_render_rows, ec_render_row_count, request, job->argc, before, &first, given, &asked, err);
    if (result == EC_OK) result = ec_options_scene(job->argc, before, first, &request->scene, err);
    free(before);
    if (result != EC_OK) return ec_fail(err, "'%s' holds a command that this version does not understand; use the version that wrote it", now.resume);
    ec_render_options *o = &request->options;
    request->quiet = request->verbose = request->json = false;
    request->checkpoint = NULL;
    request->every = 0;
    if (now.outputs.count) request->outputs.count = 0;
    o->spp = ec_render_has_limit(&now.options) ? 0 : job->spp;
    o->time_limit = ec_render_has_limit(&now.options) ? 0 : job->time_limit;
    o->error_target = ec_render_has_limit(&now.options) ? 0 : job->error_target;
    EC_TRY(ec_options_parse(ec_render_rows, ec_render_row_count, request, argc, argv, &first, given, &asked, err));
    if (now.scene) request->scene = now.scene;
    const char *adaptive = ec_identity_value(&job->identity, "--adaptive");
    if (now.adaptive == EC_ADAPTIVE_AUTO && adaptive) request->adaptive = strcmp(adaptive, "on") ? EC_ADAPTIVE_OFF : EC_ADAPTIVE_ON;
    if (!request->checkpoint) request->checkpoint = request->resume;
    return ec_render_request_settle(request, ec_render_rows, ec_render_row_count, given, err);
}
