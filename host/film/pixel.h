/* Statistics of a film's pixels: means, deviations and tails, from the film's sums. */
#ifndef EC_FILM_PIXEL_H
#define EC_FILM_PIXEL_H

#include "film/film.h"

/* Deviations are those of the replicates' means from the pixel's, so that the variance of the pixel's mean is m2 / (n (n - 1)). Where
 * replicates have different numbers of samples, each squared deviation is multiplied by n times the replicate's share of them: then the
 * variance is unbiased for independent samples. */
typedef struct ec_pixel {
    double mean[3];
    double m2[4];       /* sums of squared deviations of R, G, B and luminance */
    double m3, m4;      /* of third and fourth powers, luminance's */
    uint32_t n;         /* replicates that have samples */
    double samples;
    float tail[3];      /* of the samples' luminance: ec_sums.tail */
} ec_pixel;

/* Looks at pixels [first, first + count), in row order. */
void ec_film_look(const ec_film *film, uint64_t first, uint64_t count, ec_pixel *pixels);

/* Writes the means of one replicate alone, 3 a pixel: 0 where it has no samples. */
void ec_film_replicate(const ec_film *film, uint64_t first, uint64_t count, uint32_t replicate, double *mean);

/* Adds a pixel's ec_sums.tail to `tail`, which must begin with zeros. */
void ec_film_tail(const ec_film *film, uint64_t pixel, float tail[3]);

/* Returns the squared standard error of the pixel's mean: of channel 0 to 2, or of luminance, 3. 0 with one replicate. */
static inline double ec_pixel_se2(const ec_pixel *p, int channel)
{
    return p->n >= 2 ? p->m2[channel] / (p->n * (p->n - 1.0)) : 0;
}

enum { EC_PIXELS = 128 }; /* a piece of a film that stays in the cache */

#endif
