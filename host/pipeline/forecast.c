#include "pipeline/forecast.h"

#include <math.h>

#include "film/forecast.h"

bool ec_pilot_is_over(uint32_t batches)
{
    return batches >= 4;
}

typedef struct range {
    double low, expected, high;
} range;

static range at_most(range a, double limit)
{
    return (range){fmin(a.low, limit), fmin(a.expected, limit), fmin(a.high, limit)};
}

/* Whole batches, and four at least: nothing stops before that by its error. */
static double whole(double batches)
{
    return fmax(ceil(batches - 1e-9), 4);
}

/* Where the variance is known by a wide factor, the part that no batch has met yet only adds. */
static range batches_to(ec_film_outlook o, double spread, double target)
{
    double z = 1.96 * (1 + 2 * spread), variance = o.variance; /* a wide spread is itself not well known */
    range r = {.expected = whole(ec_outlook_batches(&o, target))};
    o.variance = variance * exp(-z * spread);
    r.low = whole(ec_outlook_batches(&o, target));
    o.variance = variance * exp(z * spread * (1 + spread));
    r.high = whole(ec_outlook_batches(&o, target));
    return r;
}

/* Machines do not keep their pace: a few per cent from minute to minute, whatever the pilot's batches say. */
#define LEAST_SPREAD 0.04

ec_forecast ec_forecast_make(const ec_film *film, const ec_film_error *now, const ec_render_options *limits,
                             const ec_pace *pace, double done, double gain)
{
    uint32_t per_batch = film->samples_per_batch;
    bool known = isfinite(now->error) && now->error > 0;
    ec_film_outlook o = {now->error * now->error * done * gain, now->noisy_pixels, (double)film->width * film->height};
    double a_batch = (pace->seconds - pace->first_seconds) / (done - 1.0);
    double pace_spread = fmax(LEAST_SPREAD, pace->spread);
    range batches = {INFINITY, INFINITY, INFINITY};
    if (limits->error_target > 0 && known) batches = batches_to(o, now->spread, limits->error_target);
    if (limits->spp) batches = at_most(batches, ceil((double)limits->spp / per_batch));
    batches = (range){fmax(batches.low, done), fmax(batches.expected, done), fmax(batches.high, done)};
    /* Both spreads are of logarithms and independent. */
    double slow = exp(1.96 * pace_spread), left = batches.expected - done;
    double down = log(fmax(left, 1)) - log(fmax(batches.low - done, 1)),
           up = log(fmax(batches.high - done, 1)) - log(fmax(left, 1));
    range seconds = {pace->seconds + left * a_batch * exp(-hypot(log(slow), down)), pace->seconds + left * a_batch,
                     pace->seconds + left * a_batch * exp(hypot(log(slow), up))};
    ec_forecast f = {.pilot_seconds = pace->seconds, .pilot_samples = (uint64_t)(done * per_batch)};
    if (limits->time_limit > 0) {
        seconds = at_most(seconds, limits->time_limit);
        batches = at_most(batches, fmax(done, done + (limits->time_limit - pace->seconds) / a_batch));
    }
    f.samples = batches.expected * per_batch;
    f.samples_low = batches.low * per_batch;
    f.samples_high = batches.high * per_batch;
    f.seconds = seconds.expected;
    f.seconds_low = seconds.low;
    f.seconds_high = seconds.high;
    f.error_bound = known && isfinite(batches.expected) ? ec_outlook_bound(&o, batches.expected) : INFINITY;
    f.spread = now->spread;
    return f;
}
