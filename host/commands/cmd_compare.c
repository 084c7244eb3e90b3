/* eclat compare A B */
#include <stdio.h>
#include <stdlib.h>

#include "base/text.h"
#include "commands/command.h"
#include "jobs/compare_gallery.h"
#include "jobs/compare_job.h"
#include "jobs/compare_pairs.h"
#include "jobs/outputs.h"
#include "report/json.h"
#include "report/names.h"

typedef struct compare_request {
    ec_compare_options asked;
    const char *html;
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
     .help = "find and report the exposure of the linear picture at which A and B differ least; if both are linear, A is scaled"},
    {.name = "html", .metavar = "FILE", EC_STORED(FILE, html), .ending = ".html",
     .help = "write a page with all pictures in it: A and B under a wipe or blinking, their difference, maps of error and FLIP; sortable"},
    {.name = "json", .help = "print one JSON object instead of text; for several pairs, an array"},
    {.name = "mask", .metavar = "FILE", EC_STORED(TEXT, asked.mask),
     .help = "compare only where this picture is white, or brighter than half"},
    {.name = "quiet", .letter = 'q', .help = "print nothing; only the exit code shows the result"},
    {.name = "tonemap", .metavar = "CURVE", EC_CHOSEN(asked.look.tonemap, ec_tonemap_names), EC_TOLD(asked.is_shown),
     .help = "compare sRGB values from 0 to 1, EXR through this " EC_TONE_CURVES_HELP,
     .otherwise = "neutral where A or B is a PNG, JPEG, WebP or AVIF; else linear values are compared"},
};

EC_ROWS(options)

static ec_result check_operands(const ec_call *call, ec_error *err)
{
    for (int i = 0; i < call->input_count; i++)
        if (!*call->inputs[i]) return ec_usage(err, "the name of a picture is empty");
    if (call->input_count < 2) return ec_usage(err, "compare needs two pictures, A and the reference B; see 'eclat compare --help'");
    return EC_OK;
}

static ec_result check_output(const char *option, const char *path, const ec_compare_pairs *pairs, const char *mask, ec_error *err)
{
    if (!path) return EC_OK;
    bool is_input = mask && ec_same_file(path, mask);
    for (uint32_t i = 0; i < pairs->count; i++) is_input |= ec_same_file(path, pairs->pair[i].a) || ec_same_file(path, pairs->pair[i].b);
    if (is_input) return ec_fail(err, "'%s' is one of the pictures compared; give --%s another name", path, option);
    return ec_image_check_writable(path, err);
}

/* The reports of all pairs, as JSON and as text. */
typedef struct results {
    cJSON *reports, *shown; /* arrays; shown: NULL if no page is wanted */
    char *text;             /* the reports as on a terminal */
    size_t size;
    FILE *to;               /* the stream that writes text */
    uint32_t differ;
} results;

static ec_result compare_pair(const ec_compare_pair *pair, const ec_compare_options *asked, results *all, ec_error *err)
{
    ec_compare_job job = {.a = {0}};
    ec_result result;
    EC_TRY_CLEANUP(ec_compare_load(pair->a, pair->b, &job, err));
    EC_TRY_CLEANUP(ec_compare_measure(&job, asked, err));
    if (all->shown) EC_TRY_CLEANUP(ec_gallery_add(all->shown, &job, err));
    cJSON_AddItemToArray(all->reports, ec_compare_report_json(&job.report));
    if (cJSON_GetArraySize(all->reports) > 1) fputc('\n', all->to);
    ec_compare_report_text(&job.report, all->to);
    all->differ += job.report.differ;
cleanup:
    ec_compare_free(&job);
    return result;
}

/* Reports one pair by itself, several as an array. */
static ec_result tell(const ec_call *call, results *all, uint32_t count, ec_error *err)
{
    if (!call->json) {
        if (!call->quiet) fputs(all->text, call->listener->to);
        return EC_OK;
    }
    cJSON *reports = count > 1 ? all->reports : cJSON_DetachItemFromArray(all->reports, 0);
    if (count > 1) all->reports = NULL;
    return ec_json_print(reports, call->listener->to, err);
}

static ec_result run(ec_call *call, ec_error *err)
{
    compare_request *request = call->request;
    const ec_compare_options *asked = &request->asked;
    ec_compare_pairs pairs = {0};
    results all = {.reports = cJSON_CreateArray(), .shown = request->html ? cJSON_CreateArray() : NULL};
    ec_result result;
    all.to = open_memstream(&all.text, &all.size);
    EC_TRY_CLEANUP(all.to && all.reports ? EC_OK : ec_fail(err, "out of memory for a report"));
    EC_TRY_CLEANUP(check_operands(call, err));
    EC_TRY_CLEANUP(ec_compare_pairs_of(call->inputs, call->input_count, &pairs, err));
    if (pairs.count > 1 && asked->diff) {
        result = ec_usage(err, "--diff is the map of one pair; --html shows those of %u", pairs.count);
        goto cleanup;
    }
    EC_TRY_CLEANUP(check_output("diff", asked->diff, &pairs, asked->mask, err));
    EC_TRY_CLEANUP(check_output("html", request->html, &pairs, asked->mask, err));
    if (pairs.alone > 0) ec_warn(&call->listener->log, "%u picture%s of '%s' %s no counterpart in '%s'; left out", pairs.alone,
                                 pairs.alone == 1 ? "" : "s", call->inputs[0], pairs.alone == 1 ? "has" : "have", call->inputs[1]);
    for (uint32_t i = 0; i < pairs.count; i++) EC_TRY_CLEANUP(compare_pair(&pairs.pair[i], asked, &all, err));
    if (pairs.count > 1) fprintf(all.to, "\nall       %u of %u differ\n", all.differ, pairs.count);
    if (request->html) ec_text_print(all.to, "page      ", request->html, "\n");
    fflush(all.to);
    if (request->html) EC_TRY_CLEANUP(ec_gallery_write(request->html, all.shown, all.text, err));
    call->says_no = all.differ > 0;
    EC_TRY_CLEANUP(tell(call, &all, pairs.count, err));
cleanup:
    if (all.to) fclose(all.to);
    free(all.text);
    cJSON_Delete(all.reports);
    cJSON_Delete(all.shown);
    ec_compare_pairs_free(&pairs);
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
    .told = {.name = "compare", .operands = "A... B [options]", .summary = "test whether two images differ by more than noise",
             .intro = "Measures how far picture A is from the reference B: root-mean-square error relative to B's mean luminance (the quantity that a render's stated error "
                      "estimates), RMSE, relMSE, MAPE, PSNR, FLIP and SSIM. If a picture has standard errors (channels stderr.R, .G, .B), tests whether the two differ by "
                      "more than noise: in the mean, in blocks of 8x8 pixels, in single values, and in the share of outliers. EXR and Radiance files of any renderer are "
                      "read, and PNG, JPEG, WebP and AVIF: then both are compared as a screen shows them, EXR through a tone curve that takes its standard errors along. "
                      "Pixels that are not opaque are left out. Of several pictures the last is the reference of all; of two folders, pictures with the same name are compared, "
                      "whatever their extensions.",
             .notes = notes},
    .rows = list_rows, .size = sizeof(compare_request), .run = run,
};
