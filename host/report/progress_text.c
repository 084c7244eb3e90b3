#include "report/progress_text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "report/format.h"

/* Rounds to two digits: a forecast is not more precise. */
static void format_samples(double samples, char *text, size_t size)
{
    double unit = pow(10, fmax(floor(log10(fmax(samples, 1))) - 1, 0));
    snprintf(text, size, "%.0f", round(samples / unit) * unit);
}

static void format_span(const ec_forecast *f, char *text, size_t size)
{
    if (f->seconds_low == f->seconds_high) snprintf(text, size, "%s", ec_seconds(f->seconds).text); /* --time ends it */
    else snprintf(text, size, "%s (95 %%: %s to %s)", ec_seconds(f->seconds).text, ec_seconds(f->seconds_low).text, ec_seconds(f->seconds_high).text);
}

void ec_forecast_text(const ec_forecast *f, const ec_render_options *options, char *text, size_t size)
{
    char samples[32], span[128], tail[96] = "";
    format_samples(f->samples, samples, sizeof samples);
    format_span(f, span, sizeof span);
    if (f->spread > 0.3) snprintf(tail, sizeof tail, "; a few pixels hold most of the noise: it may well be more");
    if (!isfinite(f->seconds))
        snprintf(text, size, "%s %s", options->error_target > 0 ? ec_percent(options->error_target).text : "the end",
                 f->is_open ? "cannot be predicted: rare bright paths decide" : "cannot be predicted yet");
    else if (f->is_open)
        snprintf(text, size, "about %s samples a pixel, %s; the error then cannot be predicted: rare bright paths decide", samples, span);
    else if (options->error_target > 0 && f->error_bound <= options->error_target * 1.02)
        snprintf(text, size, "%s needs about %s samples a pixel, %s%s", ec_percent(options->error_target).text, samples, span, tail);
    else
        snprintf(text, size, "%s%sabout %s samples a pixel, %s, error then about %s%s",
                 options->error_target > 0 ? ec_percent(options->error_target).text : "",
                 options->error_target > 0 ? " is out of reach: " : "", samples, span,
                 isfinite(f->error_bound) ? ec_percent(f->error_bound).text : "unknown", tail);
}

static void format_time_left(double seconds, char *text, size_t size)
{
    if (!(seconds >= 0) || seconds > 360000)
        snprintf(text, size, "time left unknown");
    else if (seconds < 3600)
        snprintf(text, size, "%d:%02d left", (int)seconds / 60, (int)seconds % 60);
    else
        snprintf(text, size, "%d:%02d:%02d left", (int)seconds / 3600, (int)seconds / 60 % 60, (int)seconds % 60);
}

void ec_progress_text(const ec_progress *progress, char *text, size_t size)
{
    char left[48], error[96] = "error unknown yet";
    const double fraction = progress->fraction >= 0 ? fmin(progress->fraction, 1) : 0; /* NaN: 0 */
    format_time_left(progress->seconds_left, left, sizeof left);
    if (isfinite(progress->error_bound))
        snprintf(error, sizeof error, "error %s (bound %s)", ec_percent(progress->error).text, ec_percent(progress->error_bound).text);
    else if (isfinite(progress->error))
        snprintf(error, sizeof error, "error at least %s, no bound", ec_percent(progress->error).text);
    snprintf(text, size, "%d %%  %s  %" PRIu64 " spp  %s samples/s  %s", (int)(100 * fraction), left, progress->samples_per_pixel,
             ec_count(progress->samples_per_second).text, error);
}
