/* What is told of a render on its way and in the end. */
#include <math.h>
#include <stdio.h>

#include "base/clock.h"
#include "pipeline/adaptive.h"
#include "pipeline/render_state.h"

static double fraction_done(const ec_render_state *r, double batches, double seconds)
{
    const ec_render_options *o = r->options;
    if (r->strip_rows) /* spp alone ends them */
        return fmin(((double)r->samples_before / r->params.batch + batches * ec_render_film_pixels(r)) /
                        r->batches_wanted / ec_render_picture_pixels(r),
                    1.0);
    if (isfinite(r->forecast.seconds) && r->forecast.seconds > 0.0) return fmin(seconds / r->forecast.seconds, 1.0);
    double f = 0.0;
    if (r->batches_wanted) f = fmax(f, batches / r->batches_wanted);
    if (o->time_limit > 0.0) f = fmax(f, seconds / o->time_limit);
    if (o->error_target > 0.0 && isfinite(r->error.error_bound)) {
        double ratio = o->error_target / r->error.error_bound; /* error falls with the square root of the work */
        f = fmax(f, ratio * ratio);
    }
    return fmin(f, 1.0);
}

bool ec_render_tell(ec_render_state *r, double batches)
{
    double now = ec_now(), seconds = now - r->render_start;
    r->last_report = now;
    if (!r->progress) return true;
    double samples = (double)r->samples_before + batches * r->params.batch * ec_render_film_pixels(r);
    double f = fraction_done(r, batches, seconds);
    ec_progress progress = {
        .seconds = seconds,
        .seconds_left = f > 0.0 ? seconds * (1.0 - f) / f : -1.0,
        .fraction = f,
        .samples_per_pixel = (uint64_t)(r->strip_rows ? samples / ec_render_picture_pixels(r) : batches * r->params.batch),
        .samples = (uint64_t)samples,
        .samples_per_second = seconds > 0.0 ? samples / seconds : 0.0,
        .error = r->strip_rows ? INFINITY : r->error.error, /* that of a strip is not the picture's */
        .error_bound = r->strip_rows ? INFINITY : r->error.error_bound,
        .pilot = r->stats->forecast.pilot_samples ? &r->stats->forecast : NULL,
        .forecast = r->forecast,
    };
    return r->progress(r->user, &progress);
}

void ec_render_look_ahead(ec_render_state *r, bool at_pilot)
{
    double done = ec_render_batches_done(r), now = ec_now(), took = now - r->batch_end, batches = fmax(r->source->batches, 1.0);
    r->batch_end = now;
    if (r->first_seconds == 0.0) r->first_seconds = now - r->render_start;
    else if (at_pilot || !r->past.allotment.weight) r->sum += took, r->squares += took * took / batches, r->timed += batches;
    if (!ec_pilot_is_over(r->film->batch_count) || r->timed == 0.0) return;
    double mean = r->sum / r->timed, variance = fmax(r->squares / r->timed - mean * mean, 0.0);
    ec_pace pace = {now - r->render_start, r->first_seconds, r->timed > 1.0 ? sqrt(variance / (r->timed - 1.0)) / mean : 0.0};
    r->forecast = ec_forecast_make(r->film, &r->error, r->options, &pace, done, at_pilot ? r->past.allotment.gain : 1.0);
    if (!r->stats->forecast.pilot_samples) r->stats->forecast = r->forecast;
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
    s->samples_per_pixel = (uint64_t)((double)r->past.samples / ec_render_picture_pixels(r) + 1e-6);
    s->allotment_gain = r->past.allotment.gain;
    s->samples = r->past.samples;
    s->rays = r->rays_before + r->source->rays;
    s->samples_per_second = s->seconds > 0.0 ? (double)s->samples / s->seconds : 0.0;
    s->rays_per_second = s->seconds > 0.0 ? (double)s->rays / s->seconds : 0.0;
    s->error = r->error.error;
    s->error_bound = r->error.error_bound;
    s->relmse = r->error.relmse;
    s->trace_seconds = r->source->clocked_rays > 0
                           ? r->source->clocked_seconds / r->source->clocked_rays * (double)s->rays
                           : s->seconds;
    snprintf(s->stopped_by, sizeof s->stopped_by, "%s", r->stopped_by ? r->stopped_by : "user");
}
