#include "jobs/render_setters.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "jobs/defaults.h"
#include "jobs/denoise_choice.h"
#include "jobs/numbers.h"
#include "jobs/render_request.h"
#include "jobs/option.h"
#include "pack/scene_view.h"
#include "ranks/plan.h"

#define SETTER(name) ec_result ec_set_##name(void *target, const char *option, const char *value, ec_error *err)
#define REQUEST ((ec_render_request *)target)
#define MOMENT_MOST 1e9 /* seconds */
#define SHARDS_MOST 1000000
#define SCREEN_MOST 1e4 /* in half heights of the picture */

const char *const ec_adaptive_names[] = {[EC_ADAPTIVE_AUTO] = "auto", [EC_ADAPTIVE_ON] = "on", [EC_ADAPTIVE_OFF] = "off", NULL};
const char *const ec_png_depths[] = {"8", "16", NULL};
const char *const ec_ground_names[] = {[EC_GROUND_NONE] = "none", [EC_GROUND_MATTE] = "matte", [EC_GROUND_SHADOW] = "shadow", NULL};
const char *const ec_effects_names[] = {"needed", "all", NULL};

SETTER(at)
{
    REQUEST->choice.animated = REQUEST->choice.at_given = true;
    return ec_parse_real(option, value, 0, MOMENT_MOST, &REQUEST->choice.at, err);
}

SETTER(channels) { return ec_parse_channels(option, value, &REQUEST->channels, err); }

SETTER(shutter)
{
    REQUEST->choice.shutter = true;
    return ec_parse_span(option, value, MOMENT_MOST, &REQUEST->choice.opens, &REQUEST->choice.closes, err);
}

SETTER(up)
{
    const double *up = REQUEST->look.to.up;
    REQUEST->look.has_up = true;
    EC_TRY(ec_parse_triple(option, value, REQUEST->look.to.up, err));
    if (up[0] == 0 && up[1] == 0 && up[2] == 0) return ec_usage(err, "--%s: '%s' is not a direction; give three numbers, not all 0", option, value);
    return EC_OK;
}

static ec_result two_lenses(ec_error *err) { return ec_usage(err, "--fov and --parallel do not go together: a camera is either perspective or orthographic"); }

SETTER(fov)
{
    if (REQUEST->look.has_lens && REQUEST->look.to.tall > 0) return two_lenses(err);
    REQUEST->look.has_lens = true;
    REQUEST->look.to.tall = 0;
    return ec_parse_real(option, value, EC_FOV_LEAST, EC_FOV_MOST, &REQUEST->look.to.fov, err);
}

SETTER(parallel)
{
    if (REQUEST->look.has_lens && REQUEST->look.to.fov > 0) return two_lenses(err);
    REQUEST->look.has_lens = true;
    REQUEST->look.to.fov = 0;
    return ec_parse_real(option, value, EC_FOCUS_LEAST, EC_FOCUS_MOST, &REQUEST->look.to.tall, err);
}

SETTER(screen_window) { return ec_parse_window(option, value, SCREEN_MOST, REQUEST->options.screen_window, err); }

SETTER(denoise) { return ec_parse_denoise(option, value, &REQUEST->options.denoise, err); }

SETTER(fog)
{
    double fog[3];
    EC_TRY(ec_parse_triple(option, value, fog, err));
    if (!(fog[0] >= 0 && fog[0] <= 1e30)) return ec_usage(err, "--%s: '%s': the first number, the extinction per metre, must be from 0 to 1e30", option, value);
    if (!(fog[1] >= 0 && fog[1] <= 1)) return ec_usage(err, "--%s: '%s': the second number, the scattering albedo, must be from 0 to 1", option, value);
    if (!(fabs(fog[2]) <= 0.999)) return ec_usage(err, "--%s: '%s': the third number, the mean cosine, must be from -0.999 to 0.999", option, value);
    memcpy(REQUEST->options.fog, fog, sizeof fog);
    return EC_OK;
}

/* --ground without a value is matte. */
SETTER(ground)
{
    uint32_t index = EC_GROUND_MATTE;
    if (value) EC_TRY(ec_parse_choice(option, value, ec_ground_names, &index, err));
    REQUEST->ground = (ec_ground)index;
    return EC_OK;
}

/* --adaptive without a value means on. */
SETTER(adaptive)
{
    uint32_t index = EC_ADAPTIVE_ON;
    if (value) EC_TRY(ec_parse_choice(option, value, ec_adaptive_names, &index, err));
    REQUEST->adaptive = (ec_adaptive)index;
    return EC_OK;
}

/* Parses transparent, env, blur[:R], a colour's name, or six hexadecimal digits. */
SETTER(background)
{
    static const struct { const char *name; ec_background is; } names[] = {
        {"env", {.kind = EC_BACKDROP_ENVIRONMENT}}, {"transparent", {.kind = EC_BACKDROP_TRANSPARENT}}, {"blur", {.kind = EC_BACKDROP_BLUR, .degrees = EC_BLUR}},
        {"white", {.kind = EC_BACKDROP_COLOR, .rgb = {255, 255, 255}}}, {"black", {.kind = EC_BACKDROP_COLOR}}};
    ec_background *background = &REQUEST->background;
    const char *digits = value + (*value == '#');
    bool is_known = strlen(digits) == 6 && strspn(digits, "0123456789abcdefABCDEF") == 6;
    const unsigned long number = is_known ? strtoul(digits, NULL, 16) : 0;
    *background = (ec_background){.kind = EC_BACKDROP_COLOR, .rgb = {(uint8_t)(number >> 16), (uint8_t)(number >> 8), (uint8_t)number}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!strcmp(value, names[i].name)) *background = names[i].is, is_known = true;
    if (!strncmp(value, "blur:", 5)) {
        double degrees;
        EC_TRY(ec_parse_real(option, value + 5, EC_BLUR_LEAST, EC_BLUR_MOST, &degrees, err));
        *background = (ec_background){.kind = EC_BACKDROP_BLUR, .degrees = (float)degrees};
        is_known = true;
    }
    REQUEST->options.hides_environment = background->kind != EC_BACKDROP_ENVIRONMENT;
    return is_known ? EC_OK : ec_usage(err, "--%s: '%s' is neither env nor transparent, blur, blur:R, white, black or an sRGB colour as 3366cc", option, value);
}

SETTER(frames) { return ec_frame_range_parse(option, value, &REQUEST->frames, err); }

/* Parses RANKS[,GBIT[,MICROSECONDS]]. */
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

SETTER(shard)
{
    char first[16];
    const char *slash = strchr(value, '/');
    const size_t size = slash ? (size_t)(slash - value) : 0;
    if (!size || size >= sizeof first) return ec_usage(err, "--%s: '%s' is not I/N, as in 3/8 for the third of eight shares", option, value);
    snprintf(first, sizeof first, "%.*s", (int)size, value);
    EC_TRY(ec_parse_u32(option, slash + 1, 1, SHARDS_MOST, &REQUEST->shard_count, err));
    return ec_parse_u32(option, first, 1, REQUEST->shard_count, &REQUEST->shard, err);
}

SETTER(grid_density)
{
    double density = 0;
    EC_TRY(ec_parse_real(option, value, EC_GRID_DENSITY_LEAST, EC_GRID_DENSITY_MOST, &density, err));
    REQUEST->options.grid_density = (float)density;
    return EC_OK;
}

SETTER(light_paths)
{
    REQUEST->options.light_paths = EC_LIGHT_PATHS_AUTO;
    if (!strcmp(value, "auto")) return EC_OK;
    if (ec_parse_real(option, value, 0, EC_LIGHT_PATHS_MOST, &REQUEST->options.light_paths, err) == EC_OK) return EC_OK;
    return ec_usage(err, "--%s: '%s' is neither auto nor a number from 0 to %d", option, value, EC_LIGHT_PATHS_MOST);
}

SETTER(max_depth)
{
    if (!strcmp(value, "inf")) {
        REQUEST->options.max_depth = 0;
        REQUEST->endless = true;
        return EC_OK;
    }
    if (ec_parse_u32(option, value, 1, EC_MAX_DEPTH, &REQUEST->options.max_depth, err) == EC_OK) return EC_OK;
    return ec_usage(err, "--%s: '%s' is neither a whole number from 1 to %d nor inf", option, value, EC_MAX_DEPTH);
}

SETTER(rr)
{
    double survival = !strcmp(value, "off");
    if (survival == 0 && strcmp(value, "auto") &&
        (ec_parse_real(option, value, 0, 1, &survival, err) != EC_OK || survival == 0))
        return ec_usage(err, "--%s: '%s' is neither a probability above 0 and up to 1, nor auto or off", option, value);
    REQUEST->options.survival = survival;
    return EC_OK;
}

SETTER(seed)
{
    REQUEST->seed_is_frame = !strcmp(value, "frame");
    return REQUEST->seed_is_frame ? EC_OK : ec_parse_whole(option, value, 0, UINT64_MAX, &REQUEST->options.seed, err);
}

SETTER(effects)
{
    uint32_t index = 0;
    EC_TRY(ec_parse_choice(option, value, ec_effects_names, &index, err));
    REQUEST->options.all_effects = index == 1;
    return EC_OK;
}

/* The option may be repeated. */
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
