#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "report/denoise_report.h"
#include "report/effects_report.h"
#include "report/error_text.h"
#include "report/progress_text.h"
#include "report/format.h"
#include "report/names.h"
#include "report/render_report.h"

void ec_render_report_summary(const ec_render_report *report, char *text, size_t size)
{
    const ec_render_stats *stats = report->stats;
    char error[EC_ERROR_TEXT];
    ec_error_text(&stats->film, error, sizeof error);
    if (report->replicates < 2) snprintf(error, sizeof error, "error unknown (it takes two samples a pixel)");
    snprintf(text, size, "%s: %s at %" PRIu64 " samples a pixel in %s, %s samples/s", ec_error_grade(&stats->film, ec_render_report_clamp(report)), error,
             stats->samples_per_pixel, ec_seconds(stats->seconds).text, ec_count(stats->samples_per_second).text);
}

static void print_shared(const ec_render_stats *stats, FILE *to)
{
    const ec_follow_report *f = &stats->followed;
    fprintf(to, "  structures %s in %s, at %.3f times the cost after their last build, which took %s; programs: %u kept, %u built; buffers: %s kept, %s uploaded\n",
            ec_follow_names[f->what], ec_seconds(f->seconds).text, f->expense, ec_seconds(f->build_seconds).text, stats->programs_found,
            stats->programs_built, ec_bytes(stats->bytes_found).text, ec_bytes(stats->bytes_uploaded).text);
}

static void print_clamped(const ec_render_report *report, FILE *to)
{
    char text[256];
    if (!ec_render_report_clamp(report)) return;
    ec_clamp_text(&report->clamp, report->stats->film.is_open, text, sizeof text);
    fprintf(to, "clamped  %s\n", text);
}

void ec_frame_when(const ec_frame_facts *frame, char *text, size_t size)
{
    if (frame->turns) snprintf(text, size, "%.6g degrees", frame->degrees);
    else snprintf(text, size, "%.6g s", frame->seconds);
}

void ec_frame_report_text(const ec_render_report *report, FILE *to)
{
    char summary[EC_ERROR_TEXT + 128], when[32];
    ec_render_report_summary(report, summary, sizeof summary);
    ec_frame_when(report->frame, when, sizeof when);
    if (report->frame->name) ec_text_print(to, "", report->frame->name, ": ");
    else fprintf(to, "frame %u at %s: ", report->frame->number, when);
    fputs(summary, to);
    for (int i = 0; i < report->output_count; i++) ec_text_print(to, i ? ", " : " → ", report->outputs[i], "");
    fputc('\n', to);
    print_clamped(report, to);
    ec_denoised_text(report->denoised, to);
    if (report->verbose && !report->frame->name) print_shared(report->stats, to);
}

/* Predicts the error with four times the samples: half of it if they are independent, and less if their order helps. */
static void format_more(const ec_render_stats *stats, char *text, size_t size)
{
    *text = 0;
    if (isfinite(stats->film.error) && !stats->film.is_open)
        snprintf(text, size, "; 4 times the samples would bring the picture's error to %s or less", ec_percent(stats->film.error / 2).text);
}

/* Prints which pixels' own errors cannot be trusted; nothing without an error, or if all can. */
static void print_heavy(const ec_render_report *report, FILE *to)
{
    if (report->replicates < 2 || report->heavy_pixels == 0) return;
    char more[128];
    double pixels = (double)report->options->width * report->options->height;
    format_more(report->stats, more, sizeof more);
    fprintf(to, "pixels   %" PRIu64 " (%s) need more samples for an error of their own (channel heavy): it is at least what is stated%s\n",
            report->heavy_pixels, ec_percent((double)report->heavy_pixels / pixels).text, more);
}

static void print_help(const ec_film_error *error, FILE *to)
{
    char help[EC_ERROR_TEXT];
    ec_error_help(error, help, sizeof help);
    if (*help) fprintf(to, "helps    %s\n", help);
}

static void print_effects(const ec_render_effects *effects, FILE *to)
{
    char line[EC_EFFECT_NAMES + 32];
    ec_effects_line(effects, line, sizeof line);
    fprintf(to, "effects  %s\n", line);
}

/* Prints the time before the first ray. Some drivers cache kernels themselves; for the others eclat does, and counts them. */
static void print_setup(const ec_render_stats *stats, FILE *to)
{
    char counted[64] = "", then[64] = "", guide[64] = "";
    if (stats->cache_misses || stats->cache_hits)
        snprintf(counted, sizeof counted, " (%u compiled, %u from the cache)", stats->cache_misses, stats->cache_hits);
    if (stats->fast_after_seconds > 0) snprintf(then, sizeof then, ", fast kernels after %s", ec_seconds(stats->fast_after_seconds).text);
    if (stats->guide_seconds > 0) snprintf(guide, sizeof guide, ", guide %s", ec_seconds(stats->guide_seconds).text);
    fprintf(to, "set-up   %s%skernels %s%s, acceleration structure %s, buffers %s%s; first pixel after %s%s\n",
            stats->begun == EC_BEGUN_FAST ? "" : ec_begun_names[stats->begun], stats->begun == EC_BEGUN_FAST ? "" : " ", ec_seconds(stats->kernel_seconds).text,
            counted, ec_seconds(stats->accel_seconds).text, ec_seconds(stats->pack_seconds).text, guide, ec_seconds(stats->first_pixel_seconds).text, then);
    if (stats->keeps_kernels)
        fprintf(to, "         the device does not say that it rounds division and square root correctly: the render waits for its fast kernels and keeps them\n");
}

/* Prints launches, if these are bounded in time. */
static void print_launches(const ec_render_stats *stats, FILE *to)
{
    if (!stats->launches) return;
    fprintf(to, "launches %" PRIu64 " of kernels, in %" PRIu64 " pieces, ", stats->launches, stats->pieces);
    if (stats->longest_piece > 0) fprintf(to, "the longest of %s\n", ec_seconds(stats->longest_piece).text);
    else fprintf(to, "small ones, since the device's clock does not tell how long they take\n");
}

static const char *stop_in_words(const char *stopped_by)
{
    if (!strcmp(stopped_by, "error")) return "the error bound is under --error";
    if (!strcmp(stopped_by, "time")) return "--time is used up";
    if (!strcmp(stopped_by, "device")) return "the device failed; this is the image so far";
    if (!strcmp(stopped_by, "failure")) return "the render failed; this is the image so far";
    if (!strcmp(stopped_by, "user")) return "interrupted; this is the image so far";
    return "all samples are taken";
}

void ec_render_report_text(const ec_render_report *report, FILE *to)
{
    const ec_render_stats *stats = report->stats;
    char summary[EC_ERROR_TEXT + 128];
    for (int i = 0; i < report->output_count; i++) ec_text_print(to, "picture  ", report->outputs[i], "\n");
    ec_render_report_summary(report, summary, sizeof summary);
    fprintf(to, "result   %s, %s rays/s\n", summary, ec_count(stats->rays_per_second).text);
    print_help(&stats->film, to);
    print_clamped(report, to);
    ec_denoised_text(report->denoised, to);
    if (stats->forecast.pilot_samples > 0) {
        char forecast[256];
        ec_forecast_text(&stats->forecast, report->options, forecast, sizeof forecast);
        fprintf(to, "forecast %s; made after %.0f samples\n", forecast, stats->forecast.pilot_samples);
    }
    if (stats->instances)
        fprintf(to, "geometry %" PRIu64 " triangles in %u instances, %" PRIu64 " of them stored\n", stats->triangles,
                stats->instances, stats->stored_triangles);
    print_heavy(report, to);
    if (report->has_shadow && isfinite(report->shadow_error)) fprintf(to, "shadow   standard error %.4f of the alpha of the ground's pixels\n", report->shadow_error);
    if (report->is_exposure_auto) fprintf(to, "exposure %+.2f stops, by auto\n", report->exposure);
    fprintf(to, "stopped  %s\n", stop_in_words(stats->stopped_by));
    if (!stats->share_count)
        fprintf(to, "device   %s, %u lanes, peak memory %s\n", report->device->name, stats->lanes, ec_bytes(report->peak_memory_bytes).text);
    for (uint32_t i = 0; i < stats->share_count; i++) {
        const ec_render_share *share = &stats->shares[i];
        fprintf(to, "device   %s, %u lanes: %.4g of %" PRIu64 " samples a pixel%s\n", report->device[i].name, share->lanes,
                share->samples, stats->samples_per_pixel, share->has_failed ? ", then it failed" : "");
    }
    if (stats->peers)
        fprintf(to, "ranks    %u more: %.4g of %" PRIu64 " samples a pixel, %s received\n", stats->peers,
                stats->peer_samples, stats->samples_per_pixel, ec_bytes(stats->peer_bytes).text);
    if (stats->share_count) fprintf(to, "memory   %s at the peak\n", ec_bytes(report->peak_memory_bytes).text);
    print_setup(stats, to);
    print_launches(stats, to);
    if (report->verbose) ec_effects_text(&stats->effects, to, 9);
    else print_effects(&stats->effects, to);
    fprintf(to, "invalid  %" PRIu64 " samples\n", stats->invalid_samples);
}
