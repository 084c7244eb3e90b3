#include <math.h>
#include <stdio.h>

#include "lib/internal.h"
#include "report/progress_text.h"

/* Tells whether a text was said before, by its FNV-1a hash; if too many were, they are said again. */
static bool was_said(ec_lib_ear *ear, const char *text)
{
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (; *text; text++) hash = (hash ^ (unsigned char)*text) * UINT64_C(0x100000001b3);
    for (int i = 0; i < ear->said_count; i++)
        if (ear->said[i] == hash) return true;
    if (ear->said_count < (int)(sizeof ear->said / sizeof *ear->said)) ear->said[ear->said_count++] = hash;
    return false;
}

static void write_message(void *user, ec_severity severity, const char *text)
{
    ec_lib_ear *ear = user;
    const eclat_listener *to = ear->listener;
    const bool may_repeat = !ear->says_once || severity == EC_STATUS || severity == EC_FAILURE;
    if (!to || !to->message || (ear->is_quiet && severity < EC_WARNING) || (!may_repeat && was_said(ear, text))) return;
    to->message(to->user, (eclat_severity)severity, text);
}

static void begin(void *user, const ec_render_options *options, bool has_progress)
{
    ec_lib_ear *ear = user;
    ear->options = options;
    ear->has_predicted = false;
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
    if (p->pilot && ear->options && !ear->has_predicted) {
        char line[320];
        ec_forecast_text(p->pilot, ear->options, text, sizeof text);
        snprintf(line, sizeof line, "after %.0f samples a pixel: %s", p->pilot->pilot_samples, text);
        write_message(ear, EC_STATUS, line);
        ear->has_predicted = true;
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

/* Delivers the report; the next one will overwrite it. */
static ec_result report(void *user, ec_error *err)
{
    ec_lib_ear *ear = user;
    const eclat_listener *to = ear->listener;
    if (fflush(ear->to) != 0 || ferror(ear->to)) return ec_fail(err, "out of memory for a report");
    ear->text[ear->size] = 0; /* a longer one may have been there */
    const char *why = ear->size && to->report ? to->report(to->user, ear->text, ear->size) : NULL;
    rewind(ear->to);
    return why ? ec_fail(err, "%s", why) : EC_OK;
}

ec_listener ec_lib_listener(ec_lib_ear *ear)
{
    return (ec_listener){.user = ear, .log = {write_message, ear}, .begin = begin, .progress = show, .step = step, .end = end,
                         .should_stop = should_stop, .hint = hint, .to = ear->to, .report = report, .bold = ear->listener && ear->listener->bold};
}
