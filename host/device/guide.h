/* Builds the table by which directions are guided from what light paths met (kernels/shared/guide.h has its layout). */
#ifndef EC_DEVICE_GUIDE_H
#define EC_DEVICE_GUIDE_H

#include <stddef.h>

#include "base/error.h"

/* Light that arrives at p, in the recentred frame, from d, of unit length; flux in W of luminance, > 0. */
typedef struct ec_photon {
    float p[3], d[3], flux, spare;
} ec_photon;

/* Builds the table. *words: malloc'ed; NULL where photons are too few. Reorders photons and overwrites them. The same photons in the same order give
 * the same table. */
ec_result ec_guide_build(ec_photon *photons, size_t count, float **words, size_t *word_count, ec_error *err);

/* Returns the density per solid angle of the guide alone at p, in the recentred frame, for the unit direction d; *share: the share of directions that
 * are guided there, where all lobes are wide, or 0. words may be NULL: nothing is guided. */
double ec_guide_pdf(const float *words, const float p[3], const float d[3], double *share);

#endif
