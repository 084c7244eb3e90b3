/* A film denoised, and judged: --denoise. */
#ifndef EC_DENOISE_DENOISE_H
#define EC_DENOISE_DENOISE_H

#include "cl/cl.h"
#include "denoise/clean.h"
#include "film/denoiser.h"

/* What a denoiser that is asked for comes to, before the first sample: EC_DENOISER_OIDN or, where AUTO does not find that, EC_DENOISER_ATROUS. Fails
 * where what is named is not there. */
ec_result ec_denoiser_find(ec_denoiser asked, ec_denoiser *found, ec_error *err);

/* Into film->clean; where it cannot be judged there is none, and *out says why. denoiser: as for ec_denoiser_find; device: what EC_DENOISER_ATROUS
 * runs on. */
ec_result ec_denoise(ec_film *film, ec_denoiser denoiser, const ec_device_info *device, ec_denoised *out, ec_error *err);

#endif
