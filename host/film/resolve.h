/* A film as planes of floats. */
#ifndef EC_FILM_RESOLVE_H
#define EC_FILM_RESOLVE_H

#include "film/interval.h"

/* rgb 3 a pixel, stderr_rgb 3 and stderr_y 1 (0 with fewer than two replicates), samples 1, every samples_stride-th; the intervals; and
 * clamped 2, what a clamp took away and its standard error. Any may be NULL. */
typedef struct ec_planes {
    float *rgb, *stderr_rgb, *stderr_y, *samples;
    uint32_t samples_stride;
    ec_intervals_of intervals;
    float *clamped;
} ec_planes;

enum { EC_RESOLVE_ROWS = 16 }; /* at a time */

/* Returns how many pixels of room ec_film_resolve_rows needs for so many rows. */
uint64_t ec_resolve_room(uint32_t width, uint32_t rows);

/* Writes the planes of rows [first, first + rows). Returns the number of heavy pixels, 0 where no intervals are asked for. */
uint64_t ec_film_resolve_rows(const ec_film *film, uint32_t first, uint32_t rows, const ec_planes *planes, ec_pixel *room);

/* Writes all rows of rgb and stderr_rgb, either of which may be NULL. */
void ec_film_resolve(const ec_film *film, float *rgb, float *stderr_rgb);

#endif
