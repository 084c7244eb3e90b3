#include "jobs/listener.h"

void ec_listener_begin(const ec_listener *l, const ec_render_options *options)
{
    if (l->begin) l->begin(l->user, options);
}

bool ec_listener_progress(void *listener, const ec_progress *progress)
{
    const ec_listener *l = listener;
    return l->progress ? l->progress(l->user, progress) : !ec_listener_should_stop(l);
}

void ec_listener_end(const ec_listener *l)
{
    if (l->end) l->end(l->user);
}

bool ec_listener_should_stop(const ec_listener *l) { return l->should_stop && l->should_stop(l->user); }

void ec_listener_hint(const ec_listener *l, const char *line)
{
    if (l->hint) l->hint(l->user, line);
}

ec_result ec_listener_rendered(const ec_listener *l, const ec_render_report *report, ec_error *err)
{
    return l->rendered ? l->rendered(l->user, report, err) : EC_OK;
}

ec_result ec_listener_frame(const ec_listener *l, const ec_frame_told *frame, ec_error *err)
{
    return l->frame ? l->frame(l->user, frame, err) : EC_OK;
}

ec_result ec_listener_sequence(const ec_listener *l, const ec_sequence_told *sequence, ec_error *err)
{
    return l->sequence ? l->sequence(l->user, sequence, err) : EC_OK;
}
