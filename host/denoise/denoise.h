/* Denoises a film, and judges the result: --denoise. */
#ifndef EC_DENOISE_DENOISE_H
#define EC_DENOISE_DENOISE_H

#include "cl/cl.h"
#include "denoise/clean.h"
#include "film/denoiser.h"

/* Finds, before the first sample, which denoiser is used when `asked` is asked for: EC_DENOISER_OIDN or, where AUTO does not find that,
 * EC_DENOISER_ATROUS. Fails if the one that is named is not there. */
ec_result ec_denoiser_find(ec_denoiser asked, ec_denoiser *found, ec_error *err);

/* Denoises a film into film->clean; if the result cannot be judged there is none, and *out says why. denoiser: as for ec_denoiser_find; device: what
 * EC_DENOISER_ATROUS runs on. */
ec_result ec_denoise(ec_film *film, ec_denoiser denoiser, const ec_device_info *device, ec_denoised *out, ec_error *err);

#endif
