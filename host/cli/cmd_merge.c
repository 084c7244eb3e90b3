/* eclat merge A.exr B.exr … -o ALL.exr: slices of one job into one picture, to the same bits in any order. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/hash.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/setters.h"
#include "cli/write_outputs.h"
#include "report/error_text.h"
#include "report/merge_report.h"
#include "report/names.h"
#include "store/merge.h"

typedef struct merge_request {
    char **paths;
    int count;
    ec_outputs outputs;
    double exposure;
    ec_tonemap tonemap;
    bool partial, quiet, json;
} merge_request;

#define REQUEST ((merge_request *)target)

FLAG_SETTER(json, json)
FLAG_SETTER(partial, partial)
FLAG_SETTER(quiet, quiet)
RANGE_SETTER(exposure, ec_parse_real, -EC_EXPOSURE_MOST, EC_EXPOSURE_MOST, exposure)
CHOICE_SETTER(tonemap, tonemap, ec_tonemap, ec_tonemap_names)

SETTER(output)
{
    (void)option;
    return ec_outputs_add(&REQUEST->outputs, value, err);
}

static const ec_option options[] = {{"exposure", 0, true, set_exposure}, {"json", 0, false, set_json},
                                    {"output", 'o', true, set_output},   {"partial", 0, false, set_partial},
                                    {"quiet", 'q', false, set_quiet},    {"tonemap", 0, true, set_tonemap}};

static ec_result check_request(const merge_request *request, ec_error *err)
{
    if (request->count == 0) return ec_usage(err, "merge needs slices, A.exr B.exr …, and -o ALL.exr; see 'eclat merge --help'");
    if (request->outputs.count == 0)
        return ec_usage(err, "merge needs -o ALL.exr, where the slices come together; see 'eclat merge --help'");
    for (int i = 0; i < request->count; i++)
        for (int k = 0; k < i; k++)
            if (ec_same_file(request->paths[i], request->paths[k]))
                return ec_fail(err, "'%s' and '%s' are the same slice; leave one out", request->paths[k], request->paths[i]);
    ec_inputs inputs = {.files = (const char *const *)request->paths, .file_count = request->count};
    return ec_outputs_check(&request->outputs, &inputs, err);
}

static ec_result take_slices(const merge_request *request, ec_merge *merge, const ec_log *log, ec_error *err)
{
    char missing[512];
    EC_TRY(ec_merge_sort(request->paths, request->count, err));
    for (int i = 0; i < request->count; i++) EC_TRY(ec_merge_take(merge, request->paths[i], log, err));
    if (!ec_merge_missing(merge, missing, sizeof missing)) return EC_OK;
    if (!request->partial) return ec_fail(err, "samples %s are missing; render them with --samples, or write what there is with --partial", missing);
    ec_warn(log, "samples %s are missing: the picture is of the others", missing);
    return EC_OK;
}

typedef struct merged {
    const char *command;
    const ec_stored *all;
    ec_film_error error;
    ec_clamp_error clamp;
    ec_picture picture;
    uint64_t samples_per_pixel;
    char sha256[EC_HASH_SIZE];
} merged;

/* --clamp, as the slices had it; 0: they had none. */
static double clamp_of(const merged *m)
{
    const char *value = ec_identity_value(&m->all->job.identity, "--clamp");
    return m->all->film.limit > 0 && value ? strtod(value, NULL) : 0;
}

static ec_result write_pictures(merge_request *request, const merged *m, ec_error *err)
{
    const ec_film *film = &m->all->film;
    char why[EC_ERROR_TEXT];
    ec_error_why(&m->error, why, sizeof why);
    const bool is_bound = !m->error.is_open;
    const ec_attribute attributes[] = {
        {.name = "eclat.command", .type = EC_ATTR_STRING, .string = m->command},
        {.name = "eclat.version", .type = EC_ATTR_STRING, .string = ECLAT_VERSION},
        {.name = "eclat.replicates", .type = EC_ATTR_INT, .number = ec_film_replicates(film)},
        {.name = "eclat.samplesPerPixel", .type = EC_ATTR_INT, .number = (double)m->samples_per_pixel},
        {.name = "eclat.error", .type = EC_ATTR_DOUBLE, .number = m->error.error},
        is_bound ? (ec_attribute){.name = "eclat.errorBound", .type = EC_ATTR_DOUBLE, .number = m->error.error_bound}
                 : (ec_attribute){.name = "eclat.errorBoundWhy", .type = EC_ATTR_STRING, .string = why},
        {.name = "eclat.relMSE", .type = EC_ATTR_DOUBLE, .number = m->error.relmse},
        {.name = "eclat.device", .type = EC_ATTR_STRING, .string = m->all->job.device},
        {.name = "eclat.imageSha256", .type = EC_ATTR_STRING, .string = m->sha256},
        {.name = "eclat.clamp.limit", .type = EC_ATTR_DOUBLE, .number = clamp_of(m)}, /* these are the last: without a clamp they are left out */
        {.name = "eclat.clamp.luminance", .type = EC_ATTR_DOUBLE, .number = (double)film->limit},
        {.name = "eclat.clamp.missing", .type = EC_ATTR_DOUBLE, .number = m->clamp.missing},
        {.name = "eclat.clamp.missingStderr", .type = EC_ATTR_DOUBLE, .number = m->clamp.missing_stderr},
        {.name = "eclat.clamp.noise", .type = EC_ATTR_DOUBLE, .number = m->clamp.noise},
        {.name = "eclat.clamp.bias", .type = EC_ATTR_DOUBLE, .number = m->clamp.bias},
        {.name = "eclat.clamp.error", .type = EC_ATTR_DOUBLE, .number = m->clamp.error},
    };
    enum { OF_CLAMP = 7 };
    const ec_picture_style style = {.exposure = (float)request->exposure,
                                    .tonemap = request->tonemap,
                                    .attributes = attributes,
                                    .attribute_count = sizeof attributes / sizeof *attributes - (film->limit > 0 ? 0 : OF_CLAMP),
                                    .job = &m->all->job,
                                    .film = film,
                                    .past = &m->all->past};
    return ec_outputs_write(&request->outputs, &m->picture, &style, err);
}

static ec_result tell(const merge_request *request, const merged *m, ec_error *err)
{
    const char *outputs[EC_OUTPUTS_MAX];
    for (int i = 0; i < request->outputs.count; i++) outputs[i] = request->outputs.file[i].path;
    const ec_merge_report report = {.files = request->count,
                                    .samples_per_pixel = m->samples_per_pixel,
                                    .replicates = ec_film_replicates(&m->all->film),
                                    .heavy_pixels = m->picture.heavy_count,
                                    .error = m->error,
                                    .limit = clamp_of(m),
                                    .luminance = (double)m->all->film.limit,
                                    .clamp = m->clamp,
                                    .image_sha256 = m->sha256,
                                    .outputs = outputs,
                                    .output_count = request->outputs.count};
    if (request->json) return ec_merge_report_json(&report, stdout, err);
    if (!request->quiet) ec_merge_report_text(&report, stdout);
    return EC_OK;
}

static ec_result merge(ec_console *console, const char *command, merge_request *request, ec_error *err)
{
    const ec_log log = ec_console_log(console);
    ec_merge slices = {0};
    merged m = {.command = command, .all = &slices.all};
    ec_result result;
    EC_TRY_CLEANUP(check_request(request, err));
    EC_TRY_CLEANUP(take_slices(request, &slices, &log, err));
    m.error = ec_film_estimate_error(&slices.all.film);
    m.clamp = ec_film_clamp_error(&slices.all.film);
    m.samples_per_pixel = slices.all.past.samples / ((uint64_t)slices.all.film.width * slices.all.film.height);
    EC_TRY_CLEANUP(ec_picture_resolve(&slices.all.film, true, &m.picture, err));
    ec_hash_rgb(m.picture.rgb, (uint64_t)m.picture.width * m.picture.height, m.sha256);
    EC_TRY_CLEANUP(write_pictures(request, &m, err));
    EC_TRY_CLEANUP(tell(request, &m, err));
cleanup:
    ec_picture_free(&m.picture);
    ec_merge_free(&slices);
    return result;
}

ec_result ec_cmd_merge(ec_cli *cli, int argc, char **argv, ec_error *err)
{
    merge_request request = {0};
    int first = 0;
    ec_request asked;
    EC_TRY(ec_options_parse(options, sizeof options / sizeof options[0], &request, argc, argv, &first, NULL, &asked, err));
    if (ec_request_serve(asked, argv[0])) return EC_OK;
    request.paths = argv + first;
    request.count = argc - first;
    cli->console.quiet = request.quiet;
    return merge(&cli->console, cli->line, &request, err);
}
