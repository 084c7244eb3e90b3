#include "film/forecast.h"

#include <math.h>
#include <string.h>

#define SLOPE_MOST 3.0
#define PRIOR 0.15 /* by so much slopes of pictures differ from what their rounds show; they also change on the way */

/* The slope's excess over 1 falls by a factor e in so many e-folds of the samples: measured from 32 to 1024 samples, about 9 on the Cornell
 * box and 2 on the showcase. */
#define FADES 4.0
static double excess(const ec_film_forecast *o, double samples) { return (o->slope - 1) * exp(-fmax(log(samples / o->samples), 0) / FADES); }

double ec_film_forecast_fall(const ec_film_forecast *o, double samples)
{
    const double times = samples / o->samples, slope = o->slope - 1;
    return times * (times > 1 ? exp(FADES * (slope - excess(o, samples))) : pow(times, slope));
}

double ec_film_forecast_bound(const ec_film_forecast *o, double samples)
{
    const double times = samples / o->samples, bright = o->bright_samples * times, larger = o->larger * pow(times, -o->larger_falls);
    const double met = ec_film_error_bound(o->square / ec_film_forecast_fall(o, samples), o->noisy_pixels, bright, larger, o->pixels, o->replicates);
    return samples < o->missing_light_samples ? hypot(met, o->missing_light) : met;
}

/* Returns the samples that are needed if no light is missing. */
static double samples_if_met(const ec_film_forecast *o, double target)
{
    const ec_film_forecast met = {o->square, o->samples, o->slope, o->noisy_pixels, o->bright_samples, o->larger, o->larger_falls,
                                 o->pixels, o->replicates, 0, 0};
    double samples = o->samples * pow(o->square / (target * target), 1 / o->slope);
    for (int i = 0; i < 20; i++) { /* Newton's method on logarithms, but for the bound's factor, which hardly depends on the number */
        const double bound = ec_film_forecast_bound(&met, samples), better = samples * pow(bound / target, 2 / (1 + excess(o, samples)));
        if (fabs(better - samples) < 1e-6 * samples) return better;
        samples = fmax(better, 1);
    }
    return samples;
}

double ec_film_forecast_samples(const ec_film_forecast *o, double target)
{
    const double before = target > o->missing_light ? samples_if_met(o, sqrt(target * target - o->missing_light * o->missing_light)) : INFINITY;
    return before < o->missing_light_samples ? before : fmin(before, fmax(samples_if_met(o, target), o->missing_light_samples));
}

/* Fits ln error^2 over ln samples by least squares, over at most two octaves. A round's error^2 deviates by `spread`, mostly in common with those
 * before it, so that only an independent half of it is taken for each. The slope is a mean of 1 and what was fitted, weighted by their precision. */
static void fit(ec_slope *s, double spread)
{
    double x = 0, y = 0, xx = 0, xy = 0;
    const double n = s->count;
    for (uint32_t i = 0; i < s->count; i++) x += s->samples[i] / n, y += s->square[i] / n;
    for (uint32_t i = 0; i < s->count; i++) {
        const double dx = s->samples[i] - x;
        xx += dx * dx;
        xy += dx * (s->square[i] - y);
    }
    const double fitted = -xy / xx, variance = 0.5 * spread * spread / xx, weight = PRIOR / (PRIOR + variance);
    s->value = fmin(fmax(1 + (fitted - 1) * weight, 1), SLOPE_MOST);
    s->deviation = sqrt(variance * weight + PRIOR * PRIOR);
}

void ec_slope_restart(ec_slope *s)
{
    *s = (ec_slope){.value = 1 + (s->value - 1) / 2, .deviation = 2 * PRIOR};
}

void ec_slope_add(ec_slope *s, double samples, const ec_film_error *error)
{
    const double here = log(samples);
    if (!(s->value > 0)) s->value = 1, s->deviation = 2 * PRIOR;
    if (!isfinite(error->error) || !(error->error > 0)) return;
    uint32_t old = s->count == EC_SLOPE_ROUNDS;
    while (old < s->count && here - s->samples[old] > 2 * M_LN2 + 1e-9) old++;
    s->count -= old;
    memmove(s->samples, s->samples + old, s->count * sizeof *s->samples);
    memmove(s->square, s->square + old, s->count * sizeof *s->square);
    s->samples[s->count] = here;
    s->square[s->count++] = 2 * log(error->error);
    if (here - s->samples[0] > M_LN2 - 1e-9) fit(s, error->spread);
}
