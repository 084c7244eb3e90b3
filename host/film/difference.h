/* Measures how far a picture is from a reference, in the usual figures; docs/error.md defines them. */
#ifndef EC_FILM_DIFFERENCE_H
#define EC_FILM_DIFFERENCE_H

#include "film/measured.h"

typedef struct ec_difference {
    uint64_t pixels;              /* that count */
    uint64_t unequal;             /* of them those that differ by more than rounding and slack */
    double mean_a, mean_b;        /* mean luminance */
    double rmse;                  /* over pixels and channels */
    double relative_rms;          /* of luminance, relative to mean_b: what the stated error of a render estimates */
    double relmse;                /* mean of (a - b)^2 / (b + 0.01)^2 over pixels and channels */
    double mape;                  /* mean of |a - b| / (b + 0.01), a fraction */
    double psnr;                  /* dB, against b's peak, or else its largest value; INFINITY for equal pictures, NaN where b is black */
    /* The values of relative_rms and relmse that the noise of both would make if they were renders of one picture; NaN if no
     * standard errors are known. */
    double noise_relative_rms, noise_relmse;
} ec_difference;

/* Both pictures must have the same size, and a pixel that counts. */
ec_difference ec_measure_difference(const ec_measured *a, const ec_measured *b);

#endif
