#define EC_SHARED_SETTERS
#include "jobs/render_setters.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "jobs/defaults.h"
#include "jobs/render_request.h"
#include "jobs/setters.h"
#include "ranks/plan.h"

#define REQUEST ((ec_render_request *)target)

const char *const ec_adaptive_names[] = {[EC_ADAPTIVE_AUTO] = "auto", [EC_ADAPTIVE_ON] = "on", [EC_ADAPTIVE_OFF] = "off", NULL};

/* Alone it means on. */
SETTER(adaptive)
{
    uint32_t index = EC_ADAPTIVE_ON;
    if (value) EC_TRY(ec_parse_choice(option, value, ec_adaptive_names, &index, err));
    REQUEST->adaptive = (ec_adaptive)index;
    return EC_OK;
}

PARSED_SETTER(error, ec_parse_percent, options.error_target)
PARSED_SETTER(every, ec_parse_seconds, every)
PARSED_SETTER(time, ec_parse_seconds, options.time_limit)
RANGE_SETTER(fps, ec_parse_real, EC_FPS_LEAST, EC_FPS_MOST, frames.fps)
RANGE_SETTER(spp, ec_parse_u32, 1, EC_MAX_SPP, options.spp)
FLAG_SETTER(overwrite, overwrite)
TEXT_SETTER(resume, resume)
FLAG_SETTER(json, json)
FLAG_SETTER(quiet, quiet)
FLAG_SETTER(verbose, verbose)

SETTER(frames) { return ec_frame_range_parse(option, value, &REQUEST->frames, err); }

/* A checkpoint is an EXR, and named so, since viewers go by that. */
SETTER(checkpoint)
{
    size_t size = strlen(value);
    if (size <= 4 || value[size - 5] == '/' || strcasecmp(value + size - 4, ".exr"))
        return ec_usage(err, "--%s: '%s' must be named NAME.exr", option, value);
    REQUEST->checkpoint = value;
    return EC_OK;
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
