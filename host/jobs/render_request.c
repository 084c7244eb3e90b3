#include "jobs/render_request.h"

#include <stdlib.h>
#include <string.h>

#include "jobs/defaults.h"

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
