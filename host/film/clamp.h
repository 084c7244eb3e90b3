/* Light that a clamp takes away: where a film has a limit, it measures what was cut off the indirect light of each pixel's samples, and so the
 * picture's bias. A sample's indirect light comes over paths of more than EC_DIRECT_SEGMENTS segments; what is cut off is counted in luminance. */
#ifndef EC_FILM_CLAMP_H
#define EC_FILM_CLAMP_H

#include "film/film.h"

/* Mean luminance that a pixel lacks, and the square of its standard error, from the spread of the samples: rather too large for stratified
 * ones, too small where the rarest paths were not met. */
typedef struct ec_cut {
    double mean, se2;
} ec_cut;
ec_cut ec_film_cut(const ec_film *film, uint64_t pixel);

/* Sums over pixels in order: films that follow one another downwards, added one after the other, give the bits of the whole. Begin with zeros. */
typedef struct ec_cut_sums {
    double mean, square, se2;
} ec_cut_sums;
void ec_film_sum_cut(const ec_film *film, ec_cut_sums *sums);

/* Figures relative to the picture's mean luminance, but for `missing`. NaN where nothing is known. */
typedef struct ec_clamp_error {
    double missing, missing_stderr; /* share of the light that the picture would have without a limit */
    double noise;                   /* the picture's own standard error: ec_film_error.error */
    double bias;                    /* root of the mean over pixels of the square of what they lack, its own noise subtracted */
    double bias_most;               /* the same with that noise left in */
    double error;                   /* both together: root of the sum of their squares */
} ec_clamp_error;
ec_clamp_error ec_clamp_error_of(const ec_cut_sums *sums, const ec_film_error *noise, double pixels);
ec_clamp_error ec_film_clamp_error(const ec_film *film); /* of a whole picture */

/* Returns the bias or, where noise makes more than half of its square, the most that it may be. */
double ec_clamp_bias(const ec_clamp_error *error);

#endif
