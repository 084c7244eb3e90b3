/* Predicts how many samples an accuracy takes, from those there are. */
#ifndef EC_FILM_FORECAST_H
#define EC_FILM_FORECAST_H

#include <stdbool.h>

#include "film/film.h"

/* The squared error falls as samples^-slope: 1 for independent samples, more where their order helps. The excess over 1 fades with more samples,
 * since edges and rare paths are left (forecast.c). */
typedef struct ec_film_forecast {
    double square, samples;  /* error^2 with so many samples a pixel */
    double slope;
    double noisy_pixels, bright_samples, larger, larger_falls, pixels, replicates;
    /* The amount by which light that may be missing widens the bound, and the samples a pixel after which it is as good as found. */
    double missing_light, missing_light_samples;
} ec_film_forecast;

/* Returns how many times smaller error^2 is after so many samples a pixel. */
double ec_film_forecast_fall(const ec_film_forecast *forecast, double samples);

/* Returns the bound after so many samples a pixel. */
double ec_film_forecast_bound(const ec_film_forecast *forecast, double samples);

/* Returns the least number of samples a pixel, not whole, with a bound under `target`. */
double ec_film_forecast_samples(const ec_film_forecast *forecast, double target);

enum { EC_SLOPE_ROUNDS = 12 };

/* The slope that rounds show, with its standard error. Zero-initialise it, and add each round. */
typedef struct ec_slope {
    double value, deviation;      /* 1, and a guess, before there is an octave of rounds */
    uint32_t count;
    double samples[EC_SLOPE_ROUNDS], square[EC_SLOPE_ROUNDS]; /* logarithms, of the last rounds, the oldest first */
} ec_slope;
void ec_slope_add(ec_slope *slope, double samples, const ec_film_error *error);

/* Restarts the slope halfway between 1 and what it was, without its rounds: from here on samples go to the pixels that hold the noise, where their
 * order helps less. */
void ec_slope_restart(ec_slope *slope);

/* Samples and time that the render is predicted to take. Low and high: 95 % interval. Infinite where no limit would end it. */
typedef struct ec_forecast {
    double pilot_samples;               /* samples a pixel that the forecast is based on; 0: there was none yet */
    double pilot_seconds;
    double samples, samples_low, samples_high; /* a pixel, in all */
    double seconds, seconds_low, seconds_high; /* of rendering, in all */
    double error_bound;                 /* of the image then; infinite where it is not known */
    double slope;                       /* error^2 falls as samples^-slope at first: 1 for independent samples */
    bool is_open;                       /* rare bright paths decide (film/rare.h): no error can be predicted */
    double spread;                      /* relative uncertainty of error^2: over 0.3 a few pixels hold most of it */
} ec_forecast;

#endif
