/* eclat compare A B */
#include <string.h>

#include "commands/command.h"
#include "jobs/compare_job.h"
#include "jobs/outputs.h"
#include "report/names.h"

typedef struct compare_request {
    const char *a, *b;
    ec_compare_options asked;
} compare_request;

#define REQUEST compare_request

static const ec_option options[] = {
    {.name = "diff", .metavar = "FILE", EC_STORED(FILE, asked.diff), .ending = ".png",
     .help = "write a map of the error relative to B, a .png: black is 0.1 % or less, pale yellow 100 % or more; grey is what the mask leaves out"},
    {.name = "estimate-noise", EC_STORED(FLAG, asked.estimates_noise),
     .help = "if A has no standard errors, estimate its noise from how its difference from B varies between neighbouring pixels: for noisy "
             "pictures. Edges that differ then count as noise; surfaces do not"},
    {.name = "exposure", .metavar = "EV", EC_RANGED(REAL, asked.look.exposure, -EC_EXPOSURE_MOST, EC_EXPOSURE_MOST),
     .help = "exposure of linear pictures before the tone curve", .otherwise = "0"},
    {.name = "fit-exposure", EC_STORED(FLAG, asked.fits_exposure),
     .help = "find the exposure at which A and B differ least, of the one that is linear, and report it; of two linear ones A is multiplied"},
    {.name = "json", .help = "print one JSON object instead of text"},
    {.name = "mask", .metavar = "FILE", EC_STORED(TEXT, asked.mask),
     .help = "compare only where this picture is white, or brighter than half"},
    {.name = "quiet", .letter = 'q', .help = "print nothing; only the exit code tells"},
    {.name = "tonemap", .metavar = "CURVE", EC_CHOSEN(asked.look.tonemap, ec_tonemap_names), EC_TOLD(asked.is_shown),
     .help = "compare sRGB values from 0 to 1, EXR through this tone curve: neutral (Khronos PBR Neutral) or none",
     .otherwise = "neutral where A or B is a PNG, JPEG, WebP or AVIF; else linear values are compared"},
};

EC_ROWS(options)

static ec_result take_operands(const ec_call *call, compare_request *request, ec_error *err)
{
    if (call->input_count < 2 || !*call->inputs[0] || !*call->inputs[1])
        return ec_usage(err, "compare needs two pictures, A and the reference B; see 'eclat compare --help'");
    if (call->input_count > 2) return ec_usage(err, "two pictures at a time: '%s' is one operand too many", call->inputs[2]);
    request->a = call->inputs[0];
    request->b = call->inputs[1];
    return EC_OK;
}

static ec_result check_diff(const compare_request *request, ec_error *err)
{
    const char *diff = request->asked.diff, *mask = request->asked.mask;
    if (!diff) return EC_OK;
    if (ec_same_file(diff, request->a) || ec_same_file(diff, request->b) || (mask && ec_same_file(diff, mask)))
        return ec_fail(err, "'%s' is one of the pictures compared; give --diff another name", diff);
    return ec_image_check_writable(diff, err);
}

static ec_result run(ec_call *call, ec_error *err)
{
    compare_request *request = call->request;
    ec_compare_job job = {.a = {0}};
    ec_result result;
    EC_TRY_CLEANUP(take_operands(call, request, err));
    EC_TRY_CLEANUP(check_diff(request, err));
    EC_TRY_CLEANUP(ec_compare_load(request->a, request->b, &job, err));
    EC_TRY_CLEANUP(ec_compare_measure(&job, &request->asked, err));
    call->says_no = job.report.differ;
    if (call->json) result = ec_compare_report_json(&job.report, call->listener->to, err);
    else if (!call->quiet) ec_compare_report_text(&job.report, call->listener->to);
cleanup:
    ec_compare_free(&job);
    return result;
}

static const eclat_note notes[] = {
    {"Exit code", "0", "the images are equal, or differ no more than noise makes two renders of one scene differ"},
    {"Exit code", "1",
     "they differ by more than noise, as at most 1 pair in 100 does by chance; where neither image has standard errors, a pixel differs by more than "
     "rounding (1e-5, 1e-3 for half floats, 0.6 steps of 8 or 16 bits). Or they could not be compared: then there is an error message and nothing on standard output"},
    {"Exit code", "2", "the command line is wrong"},
    {0}};

const ec_command ec_cmd_compare = {
    .told = {.name = "compare", .operands = "A B [options]", .summary = "test whether two images differ by more than noise",
             .intro = "Measures how far picture A is from the reference B: root-mean-square error relative to B's mean luminance (the quantity that a render's stated error "
                      "estimates), RMSE, relMSE, MAPE, PSNR, FLIP and SSIM. If a picture has standard errors (channels stderr.R, .G, .B), tests whether the two differ by "
                      "more than noise: in the mean, in blocks of 8x8 pixels, in single values, and in the share of outliers. EXR and Radiance files of any renderer are "
                      "read, and PNG, JPEG, WebP and AVIF: then both are compared as a screen shows them, EXR through a tone curve that takes its standard errors along. "
                      "Pixels that are not opaque are left out.",
             .notes = notes},
    .rows = list_rows, .size = sizeof(compare_request), .run = run,
};
