/* The denoiser for where Open Image Denoise is not to be had: an edge-avoiding à-trous filter on the OpenCL device (kernels/stages/atrous.cl). */
#ifndef EC_DENOISE_ATROUS_H
#define EC_DENOISE_ATROUS_H

#include "cl/cl.h"
#include "film/film.h"

/* half: room for 3 floats a pixel each; the film's halves (denoise/judge.h), filtered, times `scale`. */
ec_result ec_atrous(const ec_device_info *device, const ec_film *film, float scale, float *const half[2], ec_error *err);

#endif
