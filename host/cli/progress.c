#include "cli/progress.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "cli/seconds.h"
#include "cli/stop.h"

#define SECONDS_BETWEEN_LINES 0.1
enum { BAR_MAX = 24, BAR_MIN = 6 };

/* Formats "[====>  ] " with `width` columns, or nothing if there is no room. */
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

static void message(void *user, eclat_severity severity, const char *text) { ec_console_say(((ec_progress_view *)user)->console, severity, text); }

static int show(void *user, const eclat_progress *progress)
{
    ec_progress_view *view = user;
    const double now = ec_seconds(), part = progress->fraction, fraction = part >= 1 ? 1 : part >= 0 ? part : 0; /* NaN: 0 */
    ec_stop_ignore_file_size();
    if (ec_console_wants_progress(view->console) && now - view->drawn_at >= SECONDS_BETWEEN_LINES) {
        char bar[BAR_MAX + 1] = "", line[300];
        if (view->has_bar) format_bar(fraction, ec_console_columns(view->console) - (int)strlen(progress->text), bar);
        snprintf(line, sizeof line, "%s%s", bar, progress->text);
        ec_console_draw(view->console, line);
        view->drawn_at = now;
    }
    return 1; /* Ctrl-C stops the job by itself */
}

static const char *report(void *user, const char *text, size_t size)
{
    ec_progress_view *view = user;
    errno = 0;
    if (fwrite(text, 1, size, stdout) == size && fflush(stdout) == 0) return NULL;
    snprintf(view->lost, sizeof view->lost, "cannot write the result to standard output: %s", errno ? strerror(errno) : "an earlier write failed");
    return view->lost;
}

static void begin(void *user, int has_progress)
{
    ec_progress_view *view = user;
    view->drawn_at = 0;
    ec_stop_ignore_file_size();
    ec_stop_catch_signals(has_progress && ec_console_wants_progress(view->console));
}

static void end(void *user)
{
    ec_stop_ignore_file_size();
    ec_console_erase(((ec_progress_view *)user)->console);
}

static void hint(void *user, const char *line)
{
    ec_progress_view *view = user;
    ec_stop_hint(NULL);
    snprintf(view->hint, sizeof view->hint, "%s", line);
    ec_stop_hint(view->hint);
}

eclat_listener ec_progress_listener(ec_progress_view *view)
{
    return (eclat_listener){.user = view, .message = message, .progress = show, .report = report, .bold = ec_console_has_bold_results(), .begin = begin,
                            .end = end, .hint = hint};
}
