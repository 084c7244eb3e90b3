/* Estimates how far a denoised picture is from the truth, without a reference. See judge.c. */
#ifndef EC_DENOISE_JUDGE_H
#define EC_DENOISE_JUDGE_H

#include <math.h>

#include "film/film.h"

enum { EC_JUDGE_REPLICATES = 4 }; /* replicates that this takes: two in each half */

/* Averages the replicates with an even (half 0) or an odd (1) number among those that have samples: halves of the film that are independent of one
 * another. out: 3 floats a pixel, the colour, each times `scale`; or with fields 4 the variance of its luminance too, by the half's own replicates. */
void ec_half(const ec_film *film, uint32_t half, float scale, uint32_t fields, float *out);

/* Estimates for a pixel's luminance. They are unbiased, so those of single pixels may be negative. */
typedef struct ec_judged {
    double luminance;              /* of the noisy picture */
    double clean, noisy;           /* squared errors of the denoised picture, the mean of both denoised halves, and of the noisy one */
    double apart;                  /* squared difference of the two, which is known */
    double noise;                  /* squared standard error of the denoised one: what is left of `clean` is bias */
    double gain;                   /* `noisy` less the covariance of both errors: half of how fast a blend's error falls as it leaves the noisy one */
    double clean_variance, noisy_variance; /* unbiased variances of the two estimates … */
    double gain_variance;          /* … that of `gain`, as an estimate of its expectation … */
    double clean_plain, gain_plain; /* … and by the replicates' variance as it is: too large where samples are rare and bright, never too small by one that came once */
    double gain_apart;             /* the covariance of `apart` with what `gain` misses of this very picture's */
    double apart_variance;         /* of `apart`, as far as the noisy picture makes it */
} ec_judged;

/* Judges row `row`; denoised: both denoised halves, 3 floats a pixel. */
void ec_judge_row(const ec_film *film, uint32_t row, const float *const denoised[2], ec_judged *out);

/* An error with its 95 % interval, all relative to the picture's mean luminance. */
typedef struct ec_stated_error {
    double error, low95, high95;   /* high95 infinite: light may be missing that no sample has met (film/rare.h) */
} ec_stated_error;

/* Sums over pixels: square errors; their variance, unbiased and plain; noisy: the part of the square errors that the noisy picture makes; least: the
 * known noise of the denoised picture, below which the error is not stated. Begin with zeros. */
typedef struct ec_judged_sum {
    double square, variance, plain, noisy, least;
} ec_judged_sum;
static inline void ec_judged_join(ec_judged_sum *into, const ec_judged_sum *next)
{
    into->square += next->square;
    into->variance += next->variance;
    into->plain += next->plain;
    into->noisy += next->noisy;
    into->least += next->least;
}

ec_stated_error ec_judged_state(const ec_judged_sum *sum, double pixels, const ec_film_error *noisy);

#endif
