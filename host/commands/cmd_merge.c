/* eclat merge A.exr B.exr … -o ALL.exr: merges slices of one job into one picture, with the same bits in any order. */
#include <string.h>

#include "commands/command.h"
#include "film/denoiser.h"
#include "jobs/defaults.h"
#include "jobs/denoise_choice.h"
#include "jobs/outputs.h"
#include "report/merge_report.h"
#include "report/names.h"

typedef struct merge_request {
    ec_outputs outputs;
    ec_denoiser denoise;
    ec_exposure exposure;
    ec_tonemap tonemap;
    bool partial;
} merge_request;

#define REQUEST merge_request

static ec_result set_denoise(void *target, const char *option, const char *value, ec_error *err)
{
    return ec_parse_denoise(option, value, &((merge_request *)target)->denoise, err);
}

static const ec_option options[] = {
    {.name = "denoise", .metavar = "WHEN", .value_optional = true, .set = set_denoise, .choices = ec_denoiser_names,
     .help = "denoise the picture and judge the denoiser, as eclat render --denoise does. It uses the first hits of all samples if slices were "
             "rendered with --denoise, else those of 8 samples a pixel in the slice that begins with sample 0", .otherwise = "off"},
    {.name = "exposure", .metavar = "EV|auto", EC_RANGED(EXPOSURE, exposure, -EC_EXPOSURE_MOST, EC_EXPOSURE_MOST),
     .help = EC_EXPOSURE_HELP, .otherwise = "0"},
    {.name = "json", .help = "print one JSON object instead of text"},
    {.name = "output", .letter = 'o', .metavar = "FILE", EC_STORED(OUTPUT, outputs), .uses = EC_OPTION_REPEATS,
     .help = "write FILE, an .exr (all data, sums included, so that it can be merged again), a .png, .jpg, .avif, .jxl or .hdr; may be repeated"},
    {.name = "partial", EC_STORED(FLAG, partial), .help = "write the picture even if samples are missing"},
    {.name = "quiet", .letter = 'q', .help = "print only warnings and errors"},
    {.name = "tonemap", .metavar = "CURVE", EC_CHOSEN(tonemap, ec_tonemap_names), .help = EC_TONE_CURVES_HELP, .otherwise = "neutral"},
};

EC_ROWS(options)

static ec_result check(const ec_call *call, const ec_outputs *outputs, ec_error *err)
{
    char **paths = call->inputs;
    const int count = call->input_count;
    if (count == 0) return ec_usage(err, "merge needs slices, A.exr B.exr …, and -o ALL.exr; see 'eclat merge --help'");
    if (outputs->count == 0 && !call->wants_picture)
        return ec_usage(err, "merge needs -o ALL.exr, where the slices come together; see 'eclat merge --help'");
    for (int i = 0; i < count; i++)
        for (int k = 0; k < i; k++)
            if (ec_same_file(paths[i], paths[k])) return ec_fail(err, "'%s' and '%s' are the same slice; leave one out", paths[k], paths[i]);
    ec_inputs inputs = {.files = (const char *const *)paths, .file_count = count};
    return ec_outputs_check(outputs, &inputs, err);
}

static ec_result tell(const ec_call *call, ec_error *err)
{
    const merge_request *request = call->request;
    const ec_merged *m = &call->merged;
    const char *outputs[EC_OUTPUTS_MAX];
    for (int i = 0; i < request->outputs.count; i++) outputs[i] = request->outputs.file[i].path;
    const ec_merge_report report = {.files = call->input_count,
                                    .samples_per_pixel = m->samples_per_pixel,
                                    .replicates = ec_film_replicates(&m->slices.all.film),
                                    .heavy_pixels = m->picture.heavy_count,
                                    .error = m->error,
                                    .limit = ec_merged_clamp(m),
                                    .luminance = (double)m->slices.all.film.limit,
                                    .clamp = m->clamp,
                                    .denoised = ec_merged_denoised(m),
                                    .image_sha256 = m->sha256,
                                    .outputs = outputs,
                                    .output_count = request->outputs.count,
                                    .exposure = ec_merged_stops(m, &request->exposure),
                                    .is_exposure_auto = request->exposure.is_auto};
    if (call->json) return ec_merge_report_json(&report, call->listener->to, err);
    if (!call->quiet) ec_merge_report_text(&report, call->listener->to);
    return EC_OK;
}

static ec_result write_merged(ec_call *call, ec_outputs *outputs, ec_error *err)
{
    const merge_request *request = call->request;
    return ec_merged_write(&call->merged, outputs, &request->exposure, request->tonemap, err);
}

static ec_result run(ec_call *call, ec_error *err)
{
    merge_request *request = call->request;
    call->write = write_merged;
    EC_TRY(check(call, &request->outputs, err));
    EC_TRY(ec_merged_make(call->inputs, call->input_count, request->partial, request->denoise, call->line, &call->merged, &call->listener->log, err));
    if (request->outputs.count) EC_TRY(write_merged(call, &request->outputs, err));
    return tell(call, err);
}

const ec_command ec_cmd_merge = {
    .told = {.name = "merge", .operands = "A.exr [B.exr ...] -o ALL.exr [options]", .summary = "combine slices that were rendered separately",
             .intro = "Combines slices that eclat render --samples wrote, or checkpoints, into one picture. In any order, the result has the same bits as a single render of "
                       "all their samples. Slices of other scenes, options or versions, and slices with samples in common, are refused."},
    .rows = list_rows, .size = sizeof(merge_request), .run = run,
};
