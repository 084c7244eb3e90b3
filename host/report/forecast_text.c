/* What the pilot says, in words. */
#include "report/forecast_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "report/format.h"

/* Two digits are more than a forecast is worth; a third avoids jumps. */
static void format_samples(double samples, char *text, size_t size)
{
    double unit = pow(10, fmax(floor(log10(fmax(samples, 1))) - 1, 0));
    snprintf(text, size, "%.0f", round(samples / unit) * unit);
}

static void format_span(const ec_forecast *f, char *text, size_t size)
{
    char expected[32], low[32], high[32];
    ec_format_seconds(f->seconds, expected, sizeof expected);
    ec_format_seconds(f->seconds_low, low, sizeof low);
    ec_format_seconds(f->seconds_high, high, sizeof high);
    snprintf(text, size, "%s (95 %%: %s to %s)", expected, low, high);
}

void ec_forecast_text(const ec_forecast *f, const ec_render_options *options, char *text, size_t size)
{
    char samples[32], span[128], target[32], bound[32], tail[96] = "";
    format_samples(f->samples, samples, sizeof samples);
    if (f->seconds_low == f->seconds_high) ec_format_seconds(f->seconds, span, sizeof span); /* --time ends it */
    else format_span(f, span, sizeof span);
    ec_format_percent(options->error_target, target, sizeof target);
    ec_format_percent(f->error_bound, bound, sizeof bound);
    if (f->spread > 0.3) snprintf(tail, sizeof tail, "; a few pixels hold most of the noise: it may well be more");
    if (!isfinite(f->seconds))
        snprintf(text, size, "%s %s", options->error_target > 0 ? target : "the end", f->is_open ? "is not foreseeable: rare bright paths decide" : "cannot be foretold yet");
    else if (f->is_open)
        snprintf(text, size, "about %s samples a pixel, %s; the error then is not foreseeable: rare bright paths decide", samples, span);
    else if (options->error_target > 0 && f->error_bound <= options->error_target * 1.02)
        snprintf(text, size, "%s needs about %s samples a pixel, %s%s", target, samples, span, tail);
    else
        snprintf(text, size, "%s%sabout %s samples a pixel, %s, error then about %s%s", options->error_target > 0 ? target : "",
                 options->error_target > 0 ? " is out of reach: " : "", samples, span, isfinite(f->error_bound) ? bound : "unknown", tail);
}
