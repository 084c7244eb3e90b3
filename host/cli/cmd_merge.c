/* eclat merge A.exr B.exr … -o ALL.exr: slices of one job into one picture, to the same bits in any order. */
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "jobs/merge_job.h"
#include "jobs/option_parser.h"
#include "jobs/outputs.h"
#include "jobs/setters.h"
#include "report/merge_report.h"
#include "report/names.h"

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

static const ec_option options[] = {
    {.name = "exposure", .metavar = "EV", .set = set_exposure, .help = "brighten the PNG by this many stops", .otherwise = "0"},
    {.name = "json", .set = set_json, .help = "print one JSON object instead of text"},
    {.name = "output", .letter = 'o', .metavar = "FILE", .set = set_output, .uses = EC_OPTION_REPEATS,
     .help = "write FILE, an .exr (all data, sums included, so that it can be merged again) or a .png; may be repeated"},
    {.name = "partial", .set = set_partial, .help = "write the picture even if samples are missing"},
    {.name = "quiet", .letter = 'q', .set = set_quiet, .help = "print only warnings and errors"},
    {.name = "tonemap", .metavar = "CURVE", .set = set_tonemap, .choices = ec_tonemap_names,
     .help = "tone curve of the PNG: neutral (Khronos PBR Neutral) or none", .otherwise = "neutral"},
};

int ec_merge_rows(ec_option *rows)
{
    memcpy(rows, options, sizeof options);
    return sizeof options / sizeof options[0];
}

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

static ec_result tell(const merge_request *request, const ec_merged *m, ec_error *err)
{
    const char *outputs[EC_OUTPUTS_MAX];
    for (int i = 0; i < request->outputs.count; i++) outputs[i] = request->outputs.file[i].path;
    const ec_merge_report report = {.files = request->count,
                                    .samples_per_pixel = m->samples_per_pixel,
                                    .replicates = ec_film_replicates(&m->slices.all.film),
                                    .heavy_pixels = m->picture.heavy_count,
                                    .error = m->error,
                                    .limit = ec_merged_clamp(m),
                                    .luminance = (double)m->slices.all.film.limit,
                                    .clamp = m->clamp,
                                    .image_sha256 = m->sha256,
                                    .outputs = outputs,
                                    .output_count = request->outputs.count};
    if (request->json) return ec_merge_report_json(&report, stdout, err);
    if (!request->quiet) ec_merge_report_text(&report, stdout);
    return EC_OK;
}

ec_result ec_cmd_merge(ec_cli *cli, int argc, char **argv, ec_error *err)
{
    merge_request request = {0};
    int first = 0;
    ec_request asked;
    EC_TRY(ec_options_parse(options, sizeof options / sizeof options[0], &request, argc, argv, &first, NULL, &asked, err));
    if (ec_cli_leaves(cli, asked)) return EC_OK;
    request.paths = argv + first;
    request.count = argc - first;
    cli->console.quiet = request.quiet;
        const ec_log log = ec_console_log(&cli->console);
    ec_merged merged = {0};
    ec_result result;
    EC_TRY_CLEANUP(check_request(&request, err));
    EC_TRY_CLEANUP(ec_merged_make(request.paths, request.count, request.partial, cli->line, &merged, &log, err));
    EC_TRY_CLEANUP(ec_merged_write(&merged, &request.outputs, request.exposure, request.tonemap, err));
    result = tell(&request, &merged, err);
cleanup:
    ec_merged_free(&merged);
    return result;
}
