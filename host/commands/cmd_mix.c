/* eclat mix IN.exr lamp=2 sky=0.5,0.6,0.8 -o OUT.exr: weights the layers of a picture anew, with their errors. */
#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "commands/command.h"
#include "jobs/mix_job.h"
#include "jobs/outputs.h"
#include "report/json.h"
#include "report/names.h"

typedef struct mix_request {
    ec_outputs outputs;
    double exposure;
    ec_tonemap tonemap;
} mix_request;

#define REQUEST mix_request

static const ec_option options[] = {
    {.name = "exposure", .metavar = "EV", EC_RANGED(REAL, exposure, -EC_EXPOSURE_MOST, EC_EXPOSURE_MOST), .help = "brightness of the PNG, in stops", .otherwise = "0"},
    {.name = "json", .help = "print one JSON object instead of text"},
    {.name = "output", .letter = 'o', .metavar = "FILE", EC_STORED(OUTPUT, outputs), .uses = EC_OPTION_REPEATS,
     .help = "write FILE, an .exr (with its layers, so that it can be mixed again), a .png, .jpg, .avif, .jxl or .hdr; may be repeated"},
    {.name = "quiet", .letter = 'q', .help = "print only warnings and errors"},
    {.name = "tonemap", .metavar = "CURVE", EC_CHOSEN(tonemap, ec_tonemap_names), .help = EC_TONE_CURVES_HELP, .otherwise = "neutral"},
};

EC_ROWS(options)

static ec_result check(const ec_call *call, const ec_outputs *outputs, ec_error *err)
{
    if (call->input_count == 0) return ec_usage(err, "mix needs a picture with layers, IN.exr, gains as in lamp=2, and -o OUT.exr; see 'eclat mix --help'");
    if (outputs->count == 0 && !call->wants_picture) return ec_usage(err, "mix needs -o OUT.exr, where the picture goes; see 'eclat mix --help'");
    ec_inputs inputs = {.files = (const char *const *)call->inputs, .file_count = 1};
    return ec_outputs_check(outputs, &inputs, err);
}

static ec_result tell(const ec_call *call, const ec_mix *mix, ec_error *err)
{
    const mix_request *request = call->request;
    const char *outputs[EC_OUTPUTS_MAX];
    FILE *to = call->listener->to;
    for (int i = 0; i < request->outputs.count; i++) outputs[i] = request->outputs.file[i].path;
    if (call->json) {
        cJSON *object = cJSON_CreateObject();
        EC_JSON(object, EC_STRING("version", ECLAT_VERSION), EC_REAL("error", mix->error), EC_REAL("mean_luminance", mix->mean_luminance));
        ec_json_text(object, "image_sha256", mix->sha256);
        ec_json_texts(object, "outputs", outputs, (size_t)request->outputs.count);
        return ec_json_print(object, to, err);
    }
    if (call->quiet) return EC_OK;
    if (isfinite(mix->error)) fprintf(to, "error %.3g %% of the mean luminance at most\n", 100 * mix->error);
    for (int i = 0; i < request->outputs.count; i++) ec_text_print(to, "", outputs[i], "\n");
    return EC_OK;
}

static ec_result write_mix(ec_call *call, ec_outputs *outputs, ec_error *err)
{
    const mix_request *request = call->request;
    return ec_mix_write(&call->mix, outputs, request->exposure, request->tonemap, err);
}

static ec_result run(ec_call *call, ec_error *err)
{
    mix_request *request = call->request;
    EC_TRY(check(call, &request->outputs, err));
    EC_TRY(ec_mix_make(call->inputs[0], call->inputs + 1, call->input_count - 1, call->line, &call->mix, err));
    call->write = write_mix;
    if (request->outputs.count) EC_TRY(write_mix(call, &request->outputs, err));
    return tell(call, &call->mix, err);
}

const ec_command ec_cmd_mix = {
    .told = {.name = "mix", .operands = "IN.exr NAME=GAIN ... -o OUT.exr [options]", .summary = "change the weights of a picture's layers of light",
             .intro = "Multiplies the light groups of a picture that eclat render --light-groups made, or its direct and indirect light, by gains and adds them up. A GAIN is a "
                      "number, or R,G,B; layers that are not named have 1. Standard errors of the result are upper bounds: layers may err alike. With all gains 1 the result is the picture, bit for bit."},
    .rows = list_rows, .size = sizeof(mix_request), .run = run,
};
