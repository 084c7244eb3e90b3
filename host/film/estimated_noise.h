/* Estimates the noise of a picture that states none, from how its difference from another one varies between neighbours. */
#ifndef EC_FILM_ESTIMATED_NOISE_H
#define EC_FILM_ESTIMATED_NOISE_H

#include "film/measured.h"

enum { EC_ESTIMATED_REPLICATES = 13 }; /* as many as 5 x 5 differences that share neighbours are worth */

/* Fills a's standard errors, 3 a pixel and of luminance 1 a pixel, taking noise for independent between pixels: what noise b states is not counted. After
 * Immerkaer, "Fast noise variance estimation" (1996), locally: edges of things that differ count as noise, whole surfaces do not. */
void ec_estimate_noise(const ec_measured *a, const ec_measured *b, float *se, float *se_y);

#endif
