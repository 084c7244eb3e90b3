/* The one place that refuses what does not go together, so that no option is ever silently without effect. */
#include "jobs/combinations.h"

#include <stdio.h>
#include <string.h>

#include "jobs/render_request.h"
#include "jobs/usage.h"
#include "report/names.h"

static bool belongs(const ec_option *option, ec_integrator integrator)
{
    return option->integrators == 0 || (option->integrators >> integrator & 1);
}

bool ec_combinations_belongs(const char *option, ec_integrator integrator)
{
    const ec_option *row = ec_render_row(option);
    return !row || belongs(row, integrator);
}

static ec_result check_owner(const ec_option *option, ec_integrator integrator, ec_error *err)
{
    char names[128] = "";
    if (belongs(option, integrator)) return EC_OK;
    for (uint32_t k = 0; k < EC_INTEGRATOR_COUNT; k++) {
        if (!(option->integrators >> k & 1)) continue;
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", used ? " or " : "", ec_integrator_names[k]);
    }
    return ec_usage(err, "--%s belongs to --integrator %s; leave it out or choose that", option->name, names);
}

static ec_result check_plan(const ec_option *options, int count, const bool *given, ec_error *err)
{
    const ec_option *plan = ec_options_find(options, count, "plan");
    if (!plan || !given[plan - options]) return EC_OK;
    for (int i = 0; i < count; i++)
        if (given[i] && options[i].uses & EC_OPTION_PART)
            return ec_usage(err, "--plan and --%s: a plan is of one whole picture, from its first sample on; leave --%s out", options[i].name,
                            options[i].name);
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
        if (given[i]) EC_TRY(check_owner(&options[i], asked->integrator, err));
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
