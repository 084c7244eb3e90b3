#include "lib/internal.h"

static void write_message(void *user, ec_severity severity, const char *text)
{
    const eclat_listener *to = ((ec_lib_ear *)user)->listener;
    if (to && to->message) to->message(to->user, (eclat_severity)severity, text);
}

static bool should_stop(void *user)
{
    const ec_lib_ear *ear = user;
    return ear->is_stopped && atomic_load(ear->is_stopped);
}

static bool show(void *user, const ec_progress *p)
{
    const eclat_listener *to = ((ec_lib_ear *)user)->listener;
    const eclat_progress told = {.fraction = p->fraction, .seconds = p->seconds, .seconds_left = p->seconds_left,
                                 .samples_per_pixel = (double)p->samples_per_pixel, .error = p->error, .error_bound = p->error_bound};
    return (!to || !to->progress || to->progress(to->user, &told)) && !should_stop(user);
}

ec_listener ec_lib_listener(ec_lib_ear *ear)
{
    return (ec_listener){.user = ear, .log = {write_message, ear}, .progress = show, .should_stop = should_stop};
}
