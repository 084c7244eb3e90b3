/* Tests whether two renders differ by more than their noise. */
#ifndef EC_FILM_NOISE_TEST_H
#define EC_FILM_NOISE_TEST_H

#include "base/error.h"
#include "film/measured.h"

/* Alarm below this p: of pairs that differ by noise alone, at most one in a hundred. */
#define EC_NOISE_SIGNIFICANCE 0.01

enum { EC_NOISE_BLOCK = 8 }; /* pixels a side */

/* The place that differs most, in standard errors. */
typedef struct ec_noise_place {
    uint32_t x, y, channel;
    double t;
} ec_noise_place;

typedef struct ec_noise_test {
    double p;                                    /* probability that noise alone makes them differ so much; 0 if an exact pixel differs */
    double p_mean, p_blocks, p_pixels, p_share;  /* the four tests that p is made of; see noise_test.c */
    double mean_difference[3], mean_t[3];        /* a - b of the picture's mean, and the same in standard errors */
    uint64_t judged, outlying;                   /* values with noise; those beyond what noise reaches 1 time in 100 */
    uint64_t exact_unequal;                      /* values without noise that differ by more than rounding */
    uint32_t exact_x, exact_y;                   /* where the first of them is */
    ec_noise_place block, pixel;
} ec_noise_test;

/* Both pictures must have the same size and a pixel that counts; at least one has standard errors. */
ec_result ec_test_noise(const ec_measured *a, const ec_measured *b, ec_noise_test *test, ec_error *err);

#endif
