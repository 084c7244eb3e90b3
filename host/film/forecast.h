/* How many batches an accuracy will take, judged from those there are. */
#ifndef EC_FILM_FORECAST_H
#define EC_FILM_FORECAST_H

#include "film/film.h"

/* With B batches in all the bound comes to sqrt(variance / B) times a factor that the number of noisy pixels decides. */
typedef struct ec_film_outlook {
    double variance;     /* of one batch, relative: mean over pixels of s^2 over the squared mean luminance */
    double noisy_pixels, pixels;
} ec_film_outlook;

/* The bound after so many batches. */
double ec_outlook_bound(const ec_film_outlook *outlook, double batches);

/* The least number of batches, not whole, with a bound under `target`. */
double ec_outlook_batches(const ec_film_outlook *outlook, double target);

#endif
