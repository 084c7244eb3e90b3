/* eclat compare A.exr B.exr */
#include <string.h>

#include "commands/command.h"
#include "jobs/compare_job.h"
#include "jobs/outputs.h"

typedef struct compare_request {
    const char *a, *b, *diff;
} compare_request;

#define REQUEST compare_request

static const ec_option options[] = {
    {.name = "diff", .metavar = "FILE", EC_STORED(FILE, diff), .ending = ".png",
     .help = "write a map of the error relative to B, a .png: black is 0.1 % or less, pale yellow 100 % or more"},
    {.name = "json", .help = "print one JSON object instead of text"},
    {.name = "quiet", .letter = 'q', .help = "print nothing; only the exit code tells"},
};

EC_ROWS(options)

static ec_result take_operands(const ec_call *call, compare_request *request, ec_error *err)
{
    if (call->input_count < 2 || !*call->inputs[0] || !*call->inputs[1])
        return ec_usage(err, "compare needs two pictures, A.exr and the reference B.exr; see 'eclat compare --help'");
    if (call->input_count > 2) return ec_usage(err, "two pictures at a time: '%s' is one operand too many", call->inputs[2]);
    request->a = call->inputs[0];
    request->b = call->inputs[1];
    return EC_OK;
}

static ec_result check_diff(const compare_request *request, ec_error *err)
{
    if (!request->diff) return EC_OK;
    if (ec_same_file(request->diff, request->a) || ec_same_file(request->diff, request->b))
        return ec_fail(err, "'%s' is one of the pictures compared; give --diff another name", request->diff);
    return ec_image_check_writable(request->diff, err);
}

static ec_result run(ec_call *call, ec_error *err)
{
    compare_request *request = call->request;
    ec_compare_job job = {.a = {0}};
    ec_result result;
    EC_TRY_CLEANUP(take_operands(call, request, err));
    EC_TRY_CLEANUP(check_diff(request, err));
    EC_TRY_CLEANUP(ec_compare_load(request->a, request->b, &job, err));
    EC_TRY_CLEANUP(ec_compare_measure(&job.report, request->diff, err));
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
     "rounding (1e-5, or 1e-3 for half floats). Or they could not be compared: then there is an error message and nothing on standard output"},
    {"Exit code", "2", "the command line is wrong"},
    {0}};

const ec_command ec_cmd_compare = {
    .told = {.name = "compare", .operands = "A.exr B.exr [options]", .summary = "test whether two images differ by more than noise",
             .intro = "Measures how far image A is from the reference B: root-mean-square error relative to B's mean luminance (the quantity that a render's stated error "
                       "estimates), RMSE, relMSE, MAPE and PSNR. If an image has standard errors (channels stderr.R, .G, .B), tests whether the two differ by more than "
                       "noise: in the mean, in blocks of 8x8 pixels, in single values, and in the share of outliers. EXR files of other renderers are read too: R, G and "
                       "B, float or half.",
             .notes = notes},
    .rows = list_rows, .size = sizeof(compare_request), .run = run,
};
