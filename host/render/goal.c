#include "render/goal.h"

#include <math.h>

/* Machines do not keep their pace: a few per cent from minute to minute, whatever the pilot's batches say. */
#define LEAST_SPREAD 0.04

typedef struct range {
    double low, expected, high;
} range;

void ec_goal_set(ec_goal *g, double samples, double seconds, double error)
{
    g->samples = samples;
    g->seconds = seconds;
    g->error = error;
    g->told = 0;
}

void ec_goal_batch(ec_goal *g, double samples, double seconds, double took)
{
    const ec_mark here = {samples, seconds};
    if (g->first.samples == 0) {
        g->first = g->recent[0] = g->recent[1] = here;
        return;
    }
    const double own = samples - g->first.samples - g->timed;
    g->took += took;
    g->squares += took * took / own;
    g->timed += own;
    if (samples < 2 * g->recent[1].samples) return;
    g->recent[0] = g->recent[1];
    g->recent[1] = here;
}

void ec_goal_restart_pace(ec_goal *g)
{
    g->first = g->recent[0] = g->recent[1] = (ec_mark){0, 0};
    g->took = g->squares = g->timed = 0;
}

/* Returns the seconds a sample takes: of the last half or more, since the first batches are small. */
static double pace(const ec_goal *g, ec_mark at)
{
    const ec_mark *from = &g->recent[0];
    return at.samples > from->samples ? (at.seconds - from->seconds) / (at.samples - from->samples) : at.seconds / fmax(at.samples, 1);
}

/* Returns the relative standard deviation of a batch's pace. */
static double pace_spread(const ec_goal *g)
{
    if (!(g->timed > 0)) return LEAST_SPREAD;
    const double mean = g->took / g->timed, variance = fmax(g->squares / g->timed - mean * mean, 0);
    return fmax(LEAST_SPREAD, sqrt(variance / fmax(g->timed - 1, 1)) / mean);
}

static range at_most(range a, double limit) { return (range){fmin(a.low, limit), fmin(a.expected, limit), fmin(a.high, limit)}; }
static range at_least(range a, double limit) { return (range){fmax(a.low, limit), fmax(a.expected, limit), fmax(a.high, limit)}; }

/* Returns the samples at the end of the round that has so many samples. */
static double whole_round(const ec_goal *g, double samples)
{
    uint32_t before;
    if (!(samples < 1e12)) return samples;
    const uint64_t wanted = (uint64_t)ceil(samples - 1e-9);
    const uint32_t batch = ec_schedule_find(g->replicates, wanted, &before);
    if (before == 0 && ec_schedule_is_round(g->replicates, batch)) return (double)wanted;
    return (double)ec_schedule_samples(g->replicates, (uint32_t)ec_schedule_round(g->replicates, batch));
}

/* Returns the samples of whichever picture is there first, the noisy or the clean one. */
static range samples_of_either(const ec_goal *g, range noisy)
{
    const ec_clean_range clean = ec_clean_goal_samples(&g->clean, g->error);
    return (range){fmin(noisy.low, whole_round(g, clean.low)), fmin(noisy.expected, whole_round(g, clean.expected)), fmin(noisy.high, whole_round(g, clean.high))};
}

/* Returns the samples to the error, with an interval. Where error^2 is known by a wide factor, the part that no sample has met yet only adds. */
static range samples_to(const ec_goal *g, const ec_film_forecast *o)
{
    const double spread = g->now.spread, wide = 1 + 2 * spread; /* a wide spread is itself not well known */
    const double expected = ec_film_forecast_samples(o, g->error), far = fmax(log(expected / o->samples), 0);
    const double from_slope = far / o->slope * fmin(g->slope.deviation, 1), z = 1.96 * wide;
    const double down = hypot(spread, from_slope) / o->slope, up = hypot(spread * (1 + spread), from_slope) / o->slope;
    return (range){whole_round(g, expected * exp(-z * down)), whole_round(g, expected), whole_round(g, expected * exp(z * up))};
}

static ec_forecast predict(const ec_goal *g, ec_mark at, double gain)
{
    const ec_film_error *now = &g->now;
    const bool is_open = now->is_open, known = isfinite(now->error) && now->error > 0 && !is_open;
    const ec_film_forecast o = {now->error * now->error * gain, at.samples, g->slope.value, now->noisy_pixels, now->bright_samples, now->larger,
                               now->larger_falls, g->pixels, g->replicates, EC_RARE_DOUBT * now->missing_light, now->missing_light_samples};
    range samples = {INFINITY, INFINITY, INFINITY};
    if (g->error > 0 && known) samples = samples_to(g, &o);
    if (g->error > 0) samples = samples_of_either(g, samples);
    if (g->samples > 0) samples = at_most(samples, g->samples);
    samples = at_least(samples, at.samples);
    /* Both spreads are of logarithms and independent. */
    const double a_sample = pace(g, at), slow = 1.96 * pace_spread(g), left = samples.expected - at.samples;
    const double down = log(fmax(left, 1)) - log(fmax(samples.low - at.samples, 1)),
                 up = log(fmax(samples.high - at.samples, 1)) - log(fmax(left, 1));
    range seconds = {at.seconds + left * a_sample * exp(-hypot(slow, down)), at.seconds + left * a_sample,
                     at.seconds + left * a_sample * exp(hypot(slow, up))};
    if (g->seconds > 0) {
        seconds = at_most(seconds, g->seconds);
        samples = at_most(samples, fmax(at.samples, at.samples + (g->seconds - at.seconds) / a_sample));
    }
    const double bound = known && isfinite(samples.expected) ? ec_film_forecast_bound(&o, samples.expected) : INFINITY;
    return (ec_forecast){.pilot_samples = at.samples, .pilot_seconds = at.seconds,
                         .samples = samples.expected, .samples_low = samples.low, .samples_high = samples.high,
                         .seconds = seconds.expected, .seconds_low = seconds.low, .seconds_high = seconds.high,
                         .error_bound = fmin(bound, ec_clean_goal_bound(&g->clean, samples.expected)),
                         .slope = g->slope.value, .is_open = is_open, .spread = now->spread};
}

void ec_goal_round(ec_goal *g, const ec_film_error *now, ec_mark at)
{
    g->now = *now;
    g->is_withheld = g->error > 0 && now->is_open && now->bound_if_met <= g->error;
    ec_slope_add(&g->slope, at.samples, now);
}

void ec_goal_predict(ec_goal *g, ec_mark at, double gain)
{
    if (!(g->timed > 0)) return;
    g->forecast = predict(g, at, gain);
    if (!(g->pilot.pilot_samples > 0)) g->pilot = g->forecast;
}

const char *ec_goal_met(const ec_goal *g, ec_mark at, bool may_judge, double next)
{
    if (g->samples > 0 && at.samples >= g->samples - 1e-9 * g->samples) return "spp";
    const bool is_clean = g->clean.samples > 0 && g->clean.now.high95 <= g->error;
    if (g->error > 0 && may_judge && (g->now.error_bound <= g->error || is_clean)) return "error";
    if (g->seconds > 0 && at.seconds + 0.5 * next * pace(g, at) > g->seconds) return "time";
    return NULL;
}

static double fraction_done(const ec_goal *g, ec_mark at)
{
    double f = 0;
    if (isfinite(g->forecast.seconds) && g->forecast.seconds > 0) return fmin(at.seconds / g->forecast.seconds, 1);
    if (g->samples > 0) f = at.samples / g->samples;
    if (g->seconds > 0) f = fmax(f, at.seconds / g->seconds);
    if (g->error > 0 && g->now.error_bound > 0 && isfinite(g->now.error_bound)) f = fmax(f, pow(g->error / g->now.error_bound, 2 / fmax(g->slope.value, 1)));
    return fmin(f, 1);
}

double ec_goal_fraction(ec_goal *g, ec_mark at)
{
    g->told = fmax(g->told, fraction_done(g, at));
    return g->told;
}

double ec_goal_seconds_left(const ec_goal *g, ec_mark at)
{
    const double f = fraction_done(g, at);
    return f > 0 ? at.seconds * (1 - f) / f : -1;
}
