#define EC_SHARED_SETTERS
#include "jobs/render_setters.h"

#include <string.h>

#include "accel/accel.h"
#include "jobs/defaults.h"
#include "jobs/render_request.h"
#include "jobs/setters.h"
#include "pack/scene_view.h"
#include "report/names.h"

#define REQUEST ((ec_render_request *)target)

const char *const ec_effects_names[] = {"needed", "all", NULL};

CHOICE_SETTER(instancing, choice.instancing, ec_instancing, ec_instancing_names)
CHOICE_SETTER(integrator, options.integrator, ec_integrator, ec_integrator_names)
CHOICE_SETTER(light_choice, options.light_choice, ec_light_choice, ec_light_choice_names)
CHOICE_SETTER(sample, options.sample, ec_sample, ec_sample_names)
CHOICE_SETTER(sampler, options.sampler, ec_sampler_type, ec_sampler_names)
CHOICE_SETTER(scattering, options.scattering, ec_scattering, ec_scattering_names)
CHOICE_SETTER(terminator, options.terminator, ec_terminator, ec_terminator_names)
CHOICE_SETTER(compile, options.compile, ec_compile, ec_compile_names)
TEXT_SETTER(device, device)
PARSED_SETTER(lanes, ec_parse_lanes, options.lanes)
PARSED_SETTER(memory, ec_parse_bytes, options.memory)
RANGE_SETTER(clamp, ec_parse_real, EC_CLAMP_LEAST, EC_CLAMP_MOST, options.clamp)
RANGE_SETTER(cutoff, ec_parse_real, 0, 1, options.cutoff)
RANGE_SETTER(replicates, ec_parse_u32, 1, EC_REPLICATES_MOST, options.replicates)
RANGE_SETTER(wave, ec_parse_u32, 1, 1u << 28, options.wave)

SETTER(accel)
{
    uint32_t index = 0;
    EC_TRY(ec_parse_choice(option, value, ec_accel_names, &index, err));
    REQUEST->options.accel = ec_accel_names[index];
    return EC_OK;
}

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
    if (ec_parse_u32(option, value, 1, EC_MAX_DEPTH, &REQUEST->options.max_depth, err) == EC_OK) return EC_OK;
    return ec_usage(err, "--%s: '%s' is neither a whole number from 1 to %d nor inf", option, value, EC_MAX_DEPTH);
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
