/* The one place that refuses what does not go together, so that no option is ever silently without effect. */
#include "jobs/combinations.h"

#include <stdio.h>
#include <string.h>

#include "jobs/usage.h"
#include "report/names.h"

#define ONLY(integrator) (1u << EC_INTEGRATOR_##integrator)

/* Options that some integrators know nothing of; what is not here belongs to all of them. */
static const struct {
    const char *option;
    uint32_t integrators;
} owners[] = {
    {"max-depth", ONLY(PATH) | ONLY(WHITTED)},
    {"clamp", ONLY(PATH)},
    {"cutoff", ONLY(WHITTED)},
    {"filter", ONLY(PATH) | ONLY(WHITTED)},
    {"filter-width", ONLY(PATH) | ONLY(WHITTED)},
    {"focus", ONLY(PATH) | ONLY(WHITTED)},
    {"fstop", ONLY(PATH) | ONLY(WHITTED)},
    {"light-choice", ONLY(PATH)},
    {"rr", ONLY(PATH)},
    {"sample", ONLY(PATH)},
    {"scattering", ONLY(PATH)},
    {"terminator", ONLY(PATH)},
    {"shutter", ONLY(PATH)},
    {"accel", ONLY(PATH) | ONLY(WHITTED)},
    {"grid-density", ONLY(PATH) | ONLY(WHITTED)},
};

bool ec_combinations_belongs(const char *option, ec_integrator integrator)
{
    for (size_t i = 0; i < sizeof owners / sizeof owners[0]; i++)
        if (!strcmp(owners[i].option, option) && !(owners[i].integrators >> integrator & 1)) return false;
    return true;
}

static ec_result check_owner(const char *option, ec_integrator integrator, ec_error *err)
{
    for (size_t i = 0; i < sizeof owners / sizeof owners[0]; i++) {
        if (strcmp(owners[i].option, option) || owners[i].integrators >> integrator & 1) continue;
        char names[128] = "";
        for (uint32_t k = 0; k < EC_INTEGRATOR_COUNT; k++) {
            if (!(owners[i].integrators >> k & 1)) continue;
            size_t used = strlen(names);
            snprintf(names + used, sizeof names - used, "%s%s", used ? " or " : "", ec_integrator_names[k]);
        }
        return ec_usage(err, "--%s belongs to --integrator %s; leave it out or choose that", option, names);
    }
    return EC_OK;
}

static bool is_given(const char *name, const ec_option *options, int count, const bool *given)
{
    for (int i = 0; i < count; i++)
        if (given[i] && !strcmp(options[i].name, name)) return true;
    return false;
}

static ec_result check_plan(const ec_option *options, int count, const bool *given, ec_error *err)
{
    static const char *const others[] = {"frames", "resume", "samples", NULL};
    for (const char *const *other = others; *other && is_given("plan", options, count, given); other++)
        if (is_given(*other, options, count, given))
            return ec_usage(err, "--plan and --%s: a plan is of one whole picture, from its first sample on; leave "
                                 "--%s out", *other, *other);
    return EC_OK;
}

ec_result ec_combinations_check_grid(double density, const char *accel, bool takes_all, ec_error *err)
{
    bool fits = accel && (!strcmp(accel, "grid") || (takes_all && !strcmp(accel, "all")));
    if (density == 0 || fits) return EC_OK;
    return ec_usage(err, "--grid-density belongs to --accel grid%s; leave it out or choose that too", takes_all ? " or all" : "");
}

ec_result ec_combinations_check_shutter(const ec_scene_choice *choice, ec_error *err)
{
    if (!choice->shutter || !choice->at_given) return EC_OK;
    return ec_usage(err, "--at shows one moment and --shutter all from one to another; give one of them");
}

ec_result ec_combinations_check(const ec_option *options, int count, const bool *given, const ec_render_options *asked,
                                ec_error *err)
{
    for (int i = 0; i < count; i++)
        if (given[i]) EC_TRY(check_owner(options[i].name, asked->integrator, err));
    EC_TRY(check_plan(options, count, given, err));
    if (asked->integrator == EC_INTEGRATOR_WHITTED && asked->max_depth > EC_WHITTED_DEPTH_MOST)
        return ec_usage(err, "--integrator whitted: a --max-depth of %u is too deep for trees that keep every branch; give at most %u",
                        asked->max_depth, EC_WHITTED_DEPTH_MOST);
    if (asked->integrator == EC_INTEGRATOR_WHITTED && asked->max_depth == 0)
        return ec_usage(err, "--max-depth inf belongs to --integrator path; a ray tree needs a number up to %u",
                        EC_WHITTED_DEPTH_MOST);
    EC_TRY(ec_combinations_check_grid((double)asked->grid_density, asked->accel, false, err));
    if (asked->filter_width > 0 && asked->filter == EC_FILTER_BOX)
        return ec_usage(err, "--filter-width belongs to --filter blackman-harris; leave it out or choose that");
    if ((asked->fstop > 0) != (asked->focus > 0))
        return ec_usage(err, "--fstop and --focus go together: how wide the lens is, and how far away it is sharp; give --%s too",
                        asked->fstop > 0 ? "focus" : "fstop");
    if (asked->survival == 1 && asked->max_depth == 0)
        return ec_usage(err, "--rr off belongs with a finite --max-depth: nothing else would end a path; give --max-depth N too");
    return EC_OK;
}
