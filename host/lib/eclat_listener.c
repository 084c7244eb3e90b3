#include <math.h>
#include <stdio.h>

#include "lib/internal.h"
#include "report/forecast_text.h"
#include "report/progress_text.h"

static void write_message(void *user, ec_severity severity, const char *text)
{
    const ec_lib_ear *ear = user;
    const eclat_listener *to = ear->listener;
    if (to && to->message && (!ear->is_quiet || severity >= EC_WARNING)) to->message(to->user, (eclat_severity)severity, text);
}

static void begin(void *user, const ec_render_options *options, bool has_progress)
{
    ec_lib_ear *ear = user;
    ear->options = options;
    ear->has_foretold = false;
    if (ear->listener->begin) ear->listener->begin(ear->listener->user, has_progress);
}

static void end(void *user)
{
    const eclat_listener *to = ((ec_lib_ear *)user)->listener;
    if (to->end) to->end(to->user);
}

static bool should_stop(void *user)
{
    const ec_lib_ear *ear = user;
    return ear->is_stopped && atomic_load(ear->is_stopped);
}

static bool pass_on(ec_lib_ear *ear, const eclat_progress *told)
{
    const eclat_listener *to = ear->listener;
    if (to->progress && !to->progress(to->user, told)) atomic_store(ear->is_stopped, 1);
    return !should_stop(ear);
}

static bool show(void *user, const ec_progress *p)
{
    ec_lib_ear *ear = user;
    char text[256];
    if (p->pilot && ear->options && !ear->has_foretold) {
        char line[320];
        ec_forecast_text(p->pilot, ear->options, text, sizeof text);
        snprintf(line, sizeof line, "after %.0f samples a pixel: %s", p->pilot->pilot_samples, text);
        write_message(ear, EC_STATUS, line);
        ear->has_foretold = true;
    }
    ec_progress_text(p, text, sizeof text);
    return pass_on(ear, &(eclat_progress){.fraction = p->fraction, .seconds = p->seconds, .seconds_left = p->seconds_left, .text = text,
                                          .samples_per_pixel = (double)p->samples_per_pixel, .error = p->error, .error_bound = p->error_bound});
}

static bool step(void *user, const ec_step *s)
{
    char text[256], before[64] = "";
    if (s->seconds_left >= 0)
        snprintf(before, sizeof before, "%d %%  %d:%02d left  ", (int)(100 * s->fraction), (int)s->seconds_left / 60, (int)s->seconds_left % 60);
    snprintf(text, sizeof text, "%s%u of %u  %s", before, s->done, s->count, s->doing);
    return pass_on(user, &(eclat_progress){.fraction = s->fraction, .seconds = s->seconds, .seconds_left = s->seconds_left, .text = text,
                                           .error = INFINITY, .error_bound = INFINITY});
}

static void hint(void *user, const char *line)
{
    const eclat_listener *to = ((ec_lib_ear *)user)->listener;
    if (to->hint) to->hint(to->user, line);
}

static ec_result report(void *user, const char *text, size_t size, ec_error *err)
{
    const eclat_listener *to = ((ec_lib_ear *)user)->listener;
    const char *why = to->report ? to->report(to->user, text, size) : NULL;
    return why ? ec_fail(err, "%s", why) : EC_OK;
}

ec_listener ec_lib_listener(ec_lib_ear *ear)
{
    return (ec_listener){.user = ear, .log = {write_message, ear}, .begin = begin, .progress = show, .step = step, .end = end, .should_stop = should_stop,
                         .hint = hint, .report = report, .bold = ear->listener && ear->listener->bold};
}
