/* Samples where they lower the image's error most. */
#ifndef EC_PIPELINE_ADAPTIVE_H
#define EC_PIPELINE_ADAPTIVE_H

#include "film/film.h"
#include "shared/params.h"

/* The square error of P pixels at n_p batches is sum v_p / n_p: least for a given sum of n_p where n_p goes as sqrt(v_p)
 * (Neyman 1934). v_p comes from the pilot's sample variances of the pixels around p, p itself left out: then its number does not
 * depend on its own samples, and counting the pilot's samples in leaves the mean unbiased. (Kirk & Arvo 1991 on what else comes
 * of it.) */
typedef struct ec_allotment {
    float *weight;       /* by pixel number (kernels/lib/film.h): batches over the image's mean, mean 1; NULL: not made */
    uint32_t *place;     /* by pixel number: place in row order */
    uint32_t *list;      /* of the pass: pixel numbers (kernels/lib/film.h has those of pixels that are there twice), and places */
    uint32_t *places;
    uint32_t pixels;
    double gain;         /* error^2 by these weights over that of uniform sampling, foretold; 1 where there is nothing to gain */
    double level;        /* batches a pixel of weight 1 is due */
} ec_allotment;

/* From a film whose pixels all have the pilot's batches. Where less than 5 % is to be gained, gain is 1 and there are no weights. */
ec_result ec_allot(const ec_film *film, const ec_params *params, ec_allotment *allotment, ec_error *err);

/* One that was made before: weights, gain and level are copied. */
ec_result ec_allotment_again(const ec_allotment *made, const ec_params *params, ec_allotment *allotment, ec_error *err);

/* The next pass: list and places of the pixels that are due another batch, as often as they are; 1 to as many as the image has
 * pixels. Returns how many. */
uint32_t ec_allotment_pass(ec_allotment *allotment, const ec_film *film);

void ec_allotment_free(ec_allotment *allotment);

#endif
