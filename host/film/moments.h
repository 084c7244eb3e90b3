/* Mean and sums of powers of deviations of each pixel's batches, 68 bytes a pixel. One more value: Welford, Technometrics 4, 1962, and
 * its continuation to the third and fourth power; two sums: Chan, Golub and LeVeque 1979, and Pebay, Sandia report SAND2008-6212. */
#ifndef EC_FILM_MOMENTS_H
#define EC_FILM_MOMENTS_H

#include <stdbool.h>
#include <stdint.h>

#define EC_MOMENTS_BYTES 68 /* a pixel */

typedef struct ec_moments {
    double *mean;   /* 3 a pixel */
    double *m2;     /* 4 a pixel: R, G, B and luminance */
    float *m34;     /* 2 a pixel, of luminance. Floats suffice: they only widen the error bound, which needs a few digits of them */
    float *largest; /* 1 a pixel: luminance of its brightest batch */
} ec_moments;

/* Of no batches: zeros. False where there is no memory. */
bool ec_moments_create(ec_moments *moments, uint64_t pixels);
void ec_moments_destroy(ec_moments *moments); /* zero-initialised or destroyed is fine */

/* The same from pixel `first` on. */
static inline ec_moments ec_moments_from(const ec_moments *m, uint64_t first)
{
    return (ec_moments){m->mean + 3 * first, m->m2 + 4 * first, m->m34 + 2 * first, m->largest + first};
}

/* One after the other in memory that is owned by another, EC_MOMENTS_BYTES a pixel, aligned as malloc has it: as they are sent. */
ec_moments ec_moments_in(void *memory, uint64_t pixels);

/* Takes colours, 3 floats a pixel, in as the n-th values of so many pixels. What is not finite counts as 0; returns how many values are not. */
uint64_t ec_moments_add(const ec_moments *moments, const float *colours, double n, uint64_t pixels);

/* The same where each has a place and a number of its own, which grows by one. */
uint64_t ec_moments_add_some(const ec_moments *moments, const float *colours, const uint32_t *places, uint32_t *counts,
                             uint32_t pixels);

/* `into`, of n values, goes on with `next`, of m values. */
void ec_moments_join(const ec_moments *into, double n, const ec_moments *next, double m, uint64_t pixels);

void ec_moments_copy(const ec_moments *to, const ec_moments *from, uint64_t pixels);
void ec_moments_clear(const ec_moments *moments, uint64_t pixels);

#endif
