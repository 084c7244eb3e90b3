/* The 95 % confidence interval of every pixel, and which pixels' intervals cannot be trusted. See interval.c for the method
 * and tests/stat/test_coverage.c for how often the intervals hold the truth. */
#ifndef EC_FILM_INTERVAL_H
#define EC_FILM_INTERVAL_H

#include "film/pixel.h"

enum { EC_INTERVAL_REACH = 4 }; /* rows above and below that a pixel's interval looks at */

/* low and high: 3 floats a pixel, the interval's ends, 0 <= low <= mean <= high; 0 and infinity with fewer than two replicates.
 * heavy: 1 a pixel, 1 where the noise has too heavy a tail for its own estimate, so that the pixel's error is a lower bound; else 0.
 * Any may be NULL. */
typedef struct ec_intervals_of {
    float *low, *high, *heavy;
} ec_intervals_of;

/* Intervals of rows [first, first + rows) of `pixels`, width x height; its edges are taken for the picture's. Returns the number of heavy
 * pixels in these rows. */
uint64_t ec_intervals(const ec_pixel *pixels, uint32_t width, uint32_t height, uint32_t first, uint32_t rows,
                      const ec_intervals_of *out);

#endif
