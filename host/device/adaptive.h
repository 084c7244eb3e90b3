/* Adaptive sampling: more samples where they lower the image's error most. */
#ifndef EC_DEVICE_ADAPTIVE_H
#define EC_DEVICE_ADAPTIVE_H

#include <stdbool.h>

#include "film/film.h"
#include "shared/params.h"

/* The square error of P pixels with n_p samples is sum v_p / n_p: least for a given sum of n_p where n_p goes as sqrt(v_p) (Neyman 1934). Where the
 * order of samples helps, error^2 falls faster, but hardly so in the pixels that hold the noise. v_p comes from the replicates of the pixels around
 * p, without p itself, after the pilot and again at every power of 2: so a pixel's number of samples does not depend on its own samples, and counting
 * all samples leaves the mean unbiased. (Kirk & Arvo 1991 on what else comes of it.)
 *
 * Pixels go on as in film/schedule.h, stride by stride, all replicates of a pixel together. The level rises round by round; a pass takes strides of
 * one length, the shortest that a pixel is due at that level. */
typedef struct ec_allotment {
    float *weight;       /* by pixel number (kernels/lib/film.h): samples over the image's mean, mean 1; NULL: not made */
    uint32_t *place;     /* by pixel number: place in row order */
    uint32_t *list;      /* the pass's list: EC_LIST_WORDS an entry, kernels/shared/params.h; all replicates of a pixel one after the other, and again */
    uint32_t *places;    /* places in row order of its entries */
    float *variance;     /* in row order: variance of a sample when weights were last made */
    uint32_t pixels, replicates, room; /* room: for how many entries */
    double gain;         /* error^2 by these weights over that of uniform sampling, predicted; 1 where there is nothing to gain */
    double level;        /* samples that each replicate of a pixel of weight 1 is due */
} ec_allotment;

/* A pass's entries, at most as many as `room`, and samples of each. */
typedef struct ec_pass {
    uint32_t count, samples;
} ec_pass;

/* Makes an allotment from a film whose pixels all have the pilot's samples. Where less than 5 % is to be gained, or the image has fewer than
 * EC_ALLOT_PIXELS, gain is 1 and there are no weights. */
enum { EC_ALLOT_PIXELS = 64 };
ec_result ec_allot(const ec_film *film, const ec_params *params, ec_allotment *allotment, ec_error *err);

/* Makes an allotment like one that was made before: copies weights, gain and level. */
ec_result ec_allotment_again(const ec_allotment *made, const ec_params *params, uint32_t replicates, ec_allotment *allotment, ec_error *err);

/* Returns the next pass, of at most `most` samples in all if that is enough for one pixel. */
ec_pass ec_allotment_pass(ec_allotment *allotment, const ec_film *film, double most);

/* Returns whether every pixel has what it is due at this level. */
bool ec_allotment_is_even(const ec_allotment *allotment, const ec_film *film);

/* Returns the place in row order of the pixel with that number (kernels/lib/film.h). */
uint32_t ec_pixel_place(const ec_params *params, uint32_t number);

void ec_allotment_free(ec_allotment *allotment);

#endif
