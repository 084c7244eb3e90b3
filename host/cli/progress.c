#include "cli/progress.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "cli/stop.h"
#include "report/forecast_text.h"
#include "report/format.h"

#define SECONDS_BETWEEN_LINES 0.1
enum { BAR_MAX = 24, BAR_MIN = 6 };

/* "[====>  ] " of width columns, or nothing where there is no room for it. */
static void format_bar(double fraction, int width, char bar[BAR_MAX + 1])
{
    if (width > BAR_MAX) width = BAR_MAX;
    bar[0] = '\0';
    if (width < BAR_MIN) return;
    int inner = width - 3;
    bar[0] = '[';
    memset(bar + 1, ' ', (size_t)inner);
    memset(bar + 1, '=', (size_t)(fraction * inner));
    memcpy(bar + 1 + inner, "] ", 3);
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

void ec_progress_format(const ec_progress *progress, int columns, char *line, size_t size)
{
    char bar[BAR_MAX + 1], text[200], left[48], error[96] = "error unknown yet";
    double fraction = progress->fraction >= 0 ? fmin(progress->fraction, 1) : 0; /* NaN: 0 */
    format_time_left(progress->seconds_left, left, sizeof left);
    if (isfinite(progress->error)) {
        if (isfinite(progress->error_bound)) snprintf(error, sizeof error, "error %s (bound %s)", ec_percent(progress->error).text,
                                                      ec_percent(progress->error_bound).text);
        else snprintf(error, sizeof error, "error at least %s, no bound", ec_percent(progress->error).text);
    }
    snprintf(text, sizeof text, "%d %%  %s  %" PRIu64 " spp  %s samples/s  %s", (int)(100 * fraction), left,
             progress->samples_per_pixel, ec_count(progress->samples_per_second).text, error);
    format_bar(fraction, columns - (int)strlen(text), bar);
    snprintf(line, size, "%s%s", bar, text);
}

bool ec_progress_show(void *user, const ec_progress *progress)
{
    ec_progress_view *view = user;
    if (progress->pilot && !view->foretold) {
        char forecast[256];
        ec_forecast_text(progress->pilot, view->options, forecast, sizeof forecast);
        ec_console_say(view->console, "after %.0f samples a pixel: %s", progress->pilot->pilot_samples, forecast);
        view->foretold = true;
    }
    double now = ec_now();
    if (ec_console_wants_progress(view->console) && now - view->drawn_at >= SECONDS_BETWEEN_LINES) {
        char line[256];
        ec_progress_format(progress, ec_console_columns(view->console), line, sizeof line);
        ec_console_draw(view->console, line);
        view->drawn_at = now;
    }
    return !ec_stop_requested();
}
