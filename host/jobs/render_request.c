#include "jobs/render_request.h"

#include <string.h>

#include "jobs/defaults.h"

void ec_render_request_start(void *request)
{
    *(ec_render_request *)request = (ec_render_request){.env_strength = 1, .options.cutoff = EC_DEFAULT_CUTOFF, .options.light_paths = EC_LIGHT_PATHS_AUTO};
}

ec_channel_set ec_render_channels(const ec_render_request *r)
{
    return r->has_slice ? ec_channels_all() : r->channels ? r->channels : ec_channels_default();
}

ec_result ec_render_request_resume(const ec_job *job, const ec_given_options *now, ec_render_request *request, ec_given_options *before,
                                   ec_error *err)
{
    bool given[EC_OPTIONS_MAX] = {false};
    const char *scene = NULL;
    const ec_render_request asked = *request;
    ec_render_request_start(request);
    ec_result result = ec_given_read(before, &scene, job->argc, job->argv, ec_render_rows, ec_render_row_count, err);
    if (result == EC_OK) result = ec_given_apply(before, ec_render_rows, ec_render_row_count, request, given, err);
    if (result != EC_OK || !scene)
        return ec_fail(err, "'%s' holds a command that this version does not understand; use the version that wrote it", asked.resume);
    ec_render_options *o = &request->options;
    request->quiet = request->verbose = request->json = false;
    request->checkpoint = request->snapshot = NULL;
    request->every = 0;
    if (asked.outputs.count) request->outputs.count = 0;
    o->spp = ec_render_has_limit(&asked.options) ? 0 : job->spp;
    o->time_limit = ec_render_has_limit(&asked.options) ? 0 : job->time_limit;
    o->error_target = ec_render_has_limit(&asked.options) ? 0 : job->error_target;
    EC_TRY(ec_given_apply(now, ec_render_rows, ec_render_row_count, request, given, err));
    request->scene = asked.scene ? asked.scene : scene;
    const char *adaptive = ec_identity_value(&job->identity, "--adaptive");
    if (asked.adaptive == EC_ADAPTIVE_AUTO && adaptive) request->adaptive = strcmp(adaptive, "on") ? EC_ADAPTIVE_OFF : EC_ADAPTIVE_ON;
    if (!request->checkpoint) request->checkpoint = request->resume;
    EC_TRY(ec_render_request_settle(request, ec_render_rows, ec_render_row_count, given, err));
    const char *light_paths = ec_identity_value(&job->identity, "--light-paths");
    if (light_paths && !strcmp(light_paths, "auto")) o->light_paths = EC_LIGHT_PATHS_AUTO; /* the default with --adaptive */
    return EC_OK;
}
