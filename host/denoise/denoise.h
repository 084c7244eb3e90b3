/* A film denoised, and judged: --denoise. */
#ifndef EC_DENOISE_DENOISE_H
#define EC_DENOISE_DENOISE_H

#include "denoise/clean.h"

/* Is the library there? So that this is known before the first sample. */
ec_result ec_denoise_check(ec_error *err);

/* Into film->clean; where it cannot be judged there is none, and *out says why. */
ec_result ec_denoise(ec_film *film, ec_denoised *out, ec_error *err);

#endif
