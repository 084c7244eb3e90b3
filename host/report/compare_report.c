#include "report/compare_report.h"

#include <inttypes.h>

#include "base/text.h"
#include "report/format.h"
#include "report/json.h"
#include "report/names.h"

static ec_figure share_of(double share) { return share > 0 ? ec_percent(share) : (ec_figure){"0 %"}; }

static void print_figures(const ec_compare_report *report, FILE *to)
{
    const ec_difference *d = &report->difference;
    char noise[64] = "", noise_relmse[64] = "";
    if (isfinite(d->noise_relative_rms)) {
        snprintf(noise, sizeof noise, "; noise alone makes %s", share_of(d->noise_relative_rms).text);
        snprintf(noise_relmse, sizeof noise_relmse, " (noise alone %.3g)", d->noise_relmse);
    }
    if (d->mean_b > 0)
        fprintf(to, "error     %s of B's mean luminance, root mean square%s\n", share_of(d->relative_rms).text, noise);
    else
        fprintf(to, "error     relative to B: undefined, B is black\n");
    fprintf(to, "          RMSE %.3g, relMSE %.3g%s, MAPE %s, PSNR ", d->rmse, d->relmse, noise_relmse, share_of(d->mape).text);
    if (isfinite(d->psnr))
        fprintf(to, "%.1f dB\n", d->psnr);
    else
        fprintf(to, "%s\n", isinf(d->psnr) ? "infinite" : "undefined");
    fprintf(to, "mean      luminance %.6g in A, %.6g in B", d->mean_a, d->mean_b);
    if (d->mean_b > 0) fprintf(to, " (%+.3g %%)", 100 * (d->mean_a / d->mean_b - 1));
    fputc('\n', to);
}

/* Prints what is compared, if it is not the files' values. */
static void print_space(const ec_compare_report *report, FILE *to)
{
    const char *linear = !report->format_a && !report->format_b ? "both" : !report->format_a ? "A" : !report->format_b ? "B" : NULL;
    const uint64_t pixels = (uint64_t)report->a->width * report->a->height;
    if (report->is_shown) fputs("compared  sRGB values from 0 to 1", to);
    if (report->is_shown && linear) fprintf(to, ", %s through the tone curve %s", linear, ec_tonemap_names[report->tonemap]);
    if (report->is_shown && linear && (report->exposure != 0 || report->fitted) && !(report->fitted && !report->format_a && !report->format_b))
        fprintf(to, " at exposure %+.3g%s", report->exposure, report->fitted ? ", fitted" : "");
    if (report->is_shown) fputc('\n', to);
    if (report->fitted && !report->format_a && !report->format_b)
        fprintf(to, "exposure  A times %.4g, %+.3g stops, fitted to B\n", exp2(report->exposure), report->exposure);
    if (report->difference.pixels < pixels)
        fprintf(to, "mask      %" PRIu64 " of %" PRIu64 " pixels count, %s\n", report->difference.pixels, pixels,
                share_of((double)report->difference.pixels / (double)pixels).text);
}

static void print_seen(const ec_compare_report *report, FILE *to)
{
    fprintf(to, "seen      FLIP %.4g, SSIM ", report->flip);
    if (isfinite(report->ssim)) fprintf(to, "%.4f", report->ssim);
    else fputs("undefined", to);
    if (!report->is_shown) fprintf(to, ", through the tone curve %s", ec_tonemap_names[report->tonemap]);
    fputc('\n', to);
}

static void print_noise_of(char name, const ec_measured *image, const char *format, bool is_estimated, FILE *to)
{
    if (is_estimated)
        fprintf(to, "standard errors of %c estimated from how its difference varies between neighbouring pixels", name);
    else if (!image->se && format)
        fprintf(to, "%c is a picture for a screen, which has no standard errors, and counts as exact", name);
    else if (!image->se)
        fprintf(to, "%c has no standard errors (--channels stderr) and counts as exact", name);
    else if (isfinite(image->replicates))
        fprintf(to, "standard errors of %c from %.0f replicates", name, image->replicates);
    else
        fprintf(to, "standard errors of %c from an unknown number of replicates, taken as many", name);
}

static void print_noise(const ec_compare_report *report, FILE *to)
{
    fputs("noise     ", to);
    if (report->tested) {
        print_noise_of('A', report->a, report->format_a, report->is_estimated, to);
        fputs("; ", to);
        print_noise_of('B', report->b, report->format_b, false, to);
    } else {
        fputs("unknown: neither has standard errors (channels stderr.R, .G and .B: --channels stderr and two replicates or more)", to);
    }
    fputc('\n', to);
}

static void print_test(const ec_noise_test *test, FILE *to)
{
    const double *t = test->mean_t;
    fprintf(to, "means     R G B differ by %+.1f %+.1f %+.1f standard errors\n", t[0], t[1], t[2]);
    if (test->judged > 0)
        fprintf(to, "outliers  %.2g %% of values are beyond what noise reaches 1 time in 100 (noise alone: up to 1 %%)\n",
                100.0 * (double)test->outlying / (double)test->judged);
    fprintf(to, "worst     %+.1f standard errors in block (%u, %u) of %dx%d pixels, %+.1f in pixel (%u, %u)\n", test->block.t, test->block.x,
            test->block.y, EC_NOISE_BLOCK, EC_NOISE_BLOCK, test->pixel.t, test->pixel.x, test->pixel.y);
    if (test->exact_unequal > 0)
        fprintf(to, "exact     %" PRIu64 " value%s without noise differ%s, the first in pixel (%u, %u)\n", test->exact_unequal,
                test->exact_unequal == 1 ? "" : "s", test->exact_unequal == 1 ? "s" : "", test->exact_x, test->exact_y);
}

static void print_verdict(const ec_compare_report *report, FILE *to)
{
    uint64_t unequal = report->difference.unequal;
    fputs("verdict   ", to);
    if (unequal == 0)
        fputs("equal in every pixel\n", to);
    else if (report->tested && report->test.exact_unequal > 0)
        fputs("they differ where there is no noise\n", to);
    else if (report->tested)
        fprintf(to, "%s (p %s %.2g, alarm below %g)\n",
                report->differ ? "they differ by more than noise" : "no more different than noise makes them",
                report->test.p < 1e-99 ? "<" : "=", fmax(report->test.p, 1e-99), EC_NOISE_SIGNIFICANCE);
    else
        fprintf(to, "they differ in %" PRIu64 " pixel%s; whether that is noise cannot be told\n", unequal, unequal == 1 ? "" : "s");
}

static bool is_bent(const ec_compare_report *report)
{
    return report->is_shown && report->tested && report->difference.noise_relative_rms > EC_NOISE_BENT;
}

/* Prints why a picture has no bound: the verdict cannot know of light that it lacks. */
static void print_unbound(char name, const char *why, FILE *to)
{
    if (why) fprintf(to, "no bound  %c may lack light that shows in no standard error: %s\n", name, why);
}

void ec_compare_report_text(const ec_compare_report *report, FILE *to)
{
    ec_text_print(to, "A         ", report->path_a, "");
    if (report->format_a) fprintf(to, ", %s", report->format_a);
    ec_text_print(to, "\nB         ", report->path_b, "");
    if (report->format_b) fprintf(to, ", %s", report->format_b);
    fprintf(to, ", the reference; %ux%u pixels\n", report->a->width, report->a->height);
    print_space(report, to);
    if (report->diff_path)
        ec_text_print(to, "map       ", report->diff_path, ": error relative to B, from 0.1 % (black) to 100 % (pale yellow), logarithmic\n");
    print_figures(report, to);
    print_seen(report, to);
    print_noise(report, to);
    if (report->tested && report->difference.unequal > 0) print_test(&report->test, to);
    print_verdict(report, to);
    if (report->differ && is_bent(report))
        fprintf(to, "caution   tone curves bend noise of more than %.0f %% in ways that standard errors do not show; take more samples, or compare EXR with EXR\n", 100 * EC_NOISE_BENT);
    if (report->is_lossy_a && report->differ) fprintf(to, "lossy     A is a %s, whose losses are differences too; save a PNG\n", report->format_a);
    print_unbound('A', report->why_a, to);
    print_unbound('B', report->why_b, to);
}

static void add_picture(cJSON *root, const char *key, const char *path, const char *format, const char *why, const ec_measured *image, double mean)
{
    EC_JSON(ec_json_object(root, key), EC_STRING("path", path), EC_STRING("format", format), EC_REAL("mean_luminance", mean), EC_FLAG("standard_errors", image->se != NULL),
            EC_REAL("replicates", image->se ? image->replicates : INFINITY), EC_STRING("error_bound_why", why));
}

static void add_place(cJSON *root, const char *key, const ec_noise_place *place)
{
    EC_JSON(ec_json_object(root, key), EC_WHOLE("x", place->x), EC_WHOLE("y", place->y), EC_REAL("standard_errors", place->t));
}

static void add_test(cJSON *root, const ec_noise_test *test)
{
    EC_JSON(root, EC_REAL("p", test->p), EC_REAL("p_mean", test->p_mean), EC_REAL("p_blocks", test->p_blocks), EC_REAL("p_pixels", test->p_pixels),
            EC_REAL("p_share", test->p_share), EC_REAL("significance", EC_NOISE_SIGNIFICANCE));
    cJSON_AddItemToObject(root, "mean_difference", cJSON_CreateDoubleArray(test->mean_difference, 3));
    cJSON_AddItemToObject(root, "mean_standard_errors", cJSON_CreateDoubleArray(test->mean_t, 3));
    ec_json_real(root, "outlying_share", test->judged ? (double)test->outlying / (double)test->judged : 0);
    add_place(root, "worst_block", &test->block);
    add_place(root, "worst_pixel", &test->pixel);
    ec_json_whole(root, "exact_unequal", test->exact_unequal);
}

cJSON *ec_compare_report_json(const ec_compare_report *report)
{
    const ec_difference *d = &report->difference;
    cJSON *root = cJSON_CreateObject();
    add_picture(root, "a", report->path_a, report->format_a, report->why_a, report->a, d->mean_a);
    add_picture(root, "b", report->path_b, report->format_b, report->why_b, report->b, d->mean_b);
    EC_JSON(root, EC_WHOLE("width", report->a->width), EC_WHOLE("height", report->a->height), EC_FLAG("differ", report->differ),
            EC_WHOLE("unequal_pixels", d->unequal), EC_REAL("error", d->relative_rms), EC_REAL("error_of_noise", d->noise_relative_rms),
            EC_REAL("rmse", d->rmse), EC_REAL("relmse", d->relmse), EC_REAL("relmse_of_noise", d->noise_relmse), EC_REAL("mape", d->mape),
            EC_REAL("psnr", d->psnr), EC_REAL("flip", report->flip), EC_REAL("ssim", report->ssim), EC_WHOLE("compared_pixels", d->pixels),
            EC_STRING("space", report->is_shown ? "srgb" : "linear"), EC_STRING("tonemap", ec_tonemap_names[report->tonemap]),
            EC_REAL("exposure", report->exposure), EC_STRING("exposure_fitted", report->fitted ? (char[2]){report->fitted} : NULL),
            EC_FLAG("noise_estimated", report->is_estimated), EC_FLAG("noise_bent", is_bent(report)));
    if (report->tested)
        add_test(cJSON_AddObjectToObject(root, "noise_test"), &report->test);
    else
        cJSON_AddNullToObject(root, "noise_test");
    ec_json_text(root, "diff", report->diff_path);
    return root;
}
