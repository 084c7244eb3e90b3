/* The 95 % confidence interval of every pixel, and which pixels' intervals cannot be trusted. See interval.c for the method
 * and tests/stat/test_coverage.c for how often the intervals hold the truth. */
#ifndef EC_FILM_INTERVAL_H
#define EC_FILM_INTERVAL_H

#include "film/film.h"

enum { EC_INTERVAL_REACH = 2 };

/* Of rows [first, first + rows), whose first value comes first; they look at EC_INTERVAL_REACH rows above and below. low and high: 3 floats a
 * pixel, the interval's ends, 0 <= low <= mean <= high. heavy: 1 a pixel, 1 where the noise has too
 * heavy a tail for its own estimate, so that the pixel's error is a lower bound; else 0. Any may be NULL. Returns the number
 * of heavy pixels. With fewer than two batches nothing is known: 0, infinity, and every pixel heavy. */
uint64_t ec_film_interval_rows(const ec_film *film, uint32_t first, uint32_t rows, float *low, float *high, float *heavy);

#endif
