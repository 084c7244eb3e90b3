#include "report/progress_text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "report/format.h"

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
