#include "jobs/listener.h"

void ec_listener_begin(const ec_listener *l, const ec_render_options *options, bool has_progress)
{
    if (l->begin) l->begin(l->user, options, has_progress);
}

bool ec_listener_progress(void *listener, const ec_progress *progress)
{
    const ec_listener *l = listener;
    return l->progress ? l->progress(l->user, progress) : !ec_listener_should_stop(l);
}

bool ec_listener_step(const ec_listener *l, const ec_step *step) { return l->step ? l->step(l->user, step) : !ec_listener_should_stop(l); }

void ec_listener_end(const ec_listener *l)
{
    if (l->end) l->end(l->user);
}

bool ec_listener_should_stop(const ec_listener *l) { return l->should_stop && l->should_stop(l->user); }

void ec_listener_hint(const ec_listener *l, const char *line)
{
    if (l->hint) l->hint(l->user, line);
}
