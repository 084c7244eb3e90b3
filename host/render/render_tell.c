/* Reports a render's progress, and its figures in the end. */
#include <math.h>
#include <stdio.h>

#include "base/clock.h"
#include "render/render_state.h"

/* Returns how much is done, 0 to 1. Strips end by their samples alone. */
static double fraction_done(ec_render_state *r, ec_mark at)
{
    if (!r->strip_rows) return ec_goal_fraction(&r->goal, at);
    const double pixels = ec_render_picture_pixels(r), done = (double)r->samples_before + at.samples * ec_render_film_pixels(r);
    return fmin(done / r->goal.samples / pixels, 1.0);
}

bool ec_render_tell(ec_render_state *r, double samples_per_pixel)
{
    const ec_mark at = {samples_per_pixel, ec_now() - r->render_start};
    r->last_report = ec_now();
    if (!r->progress) return true;
    const double samples = (double)r->samples_before + samples_per_pixel * ec_render_film_pixels(r), f = fraction_done(r, at);
    ec_progress progress = {
        .seconds = at.seconds,
        .seconds_left = !r->strip_rows ? ec_goal_seconds_left(&r->goal, at) : f > 0.0 ? at.seconds * (1.0 - f) / f : -1.0,
        .fraction = f,
        .samples_per_pixel = (uint64_t)(r->strip_rows ? samples / ec_render_picture_pixels(r) : samples_per_pixel),
        .samples = (uint64_t)samples,
        .samples_per_second = at.seconds > 0.0 ? samples / at.seconds : 0.0,
        .error = r->strip_rows ? INFINITY : r->error.error, /* the error of a strip is not the picture's */
        .error_bound = r->strip_rows ? INFINITY : r->error.error_bound,
        .pilot = r->goal.pilot.pilot_samples > 0 ? &r->goal.pilot : NULL,
        .forecast = r->goal.forecast,
    };
    return r->progress(r->user, &progress);
}

void ec_render_finish_stats(ec_render_state *r)
{
    ec_render_stats *s = r->stats;
    const uint64_t *invalid = r->past.invalid;
    s->seconds = ec_now() - r->render_start;
    s->invalid_generate = invalid[EC_STAGE_GENERATE];
    s->invalid_intersect = invalid[EC_STAGE_INTERSECT];
    s->invalid_shade = invalid[EC_STAGE_SHADE];
    s->invalid_connect = invalid[EC_STAGE_CONNECT];
    s->invalid_accumulate = invalid[EC_STAGE_ACCUMULATE] + r->film->invalid_count + r->invalid_in_films; /* finite samples whose sum is not */
    s->invalid_samples = s->invalid_generate + s->invalid_intersect + s->invalid_shade + s->invalid_connect + s->invalid_accumulate;
    s->is_clean = r->cleaned_samples > 0 && r->cleaned_samples == r->past.samples;
    s->forecast = r->goal.pilot;
    s->samples_per_pixel = (uint64_t)((double)r->past.samples / ec_render_picture_pixels(r) + 1e-6);
    s->allotment_gain = r->past.allotment.gain;
    s->samples = r->past.samples;
    s->rays = r->rays_before + r->source->rays;
    s->samples_per_second = s->seconds > 0.0 ? (double)s->samples / s->seconds : 0.0;
    s->rays_per_second = s->seconds > 0.0 ? (double)s->rays / s->seconds : 0.0;
    s->film = r->error;
    s->sums = r->strip_rows ? (ec_error_sums){0} : r->sums;
    s->trace_seconds = r->source->clocked_rays > 0
                           ? r->source->clocked_seconds / r->source->clocked_rays * (double)s->rays
                           : s->seconds;
    snprintf(s->stopped_by, sizeof s->stopped_by, "%s", r->stopped_by ? r->stopped_by : "user");
}
