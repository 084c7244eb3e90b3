/* The denoiser for machines without Open Image Denoise: an edge-avoiding à-trous filter on the OpenCL device (kernels/stages/atrous.cl). */
#ifndef EC_DENOISE_ATROUS_H
#define EC_DENOISE_ATROUS_H

#include "cl/cl.h"
#include "film/film.h"

/* Filters the film's halves (denoise/judge.h), times `scale`, into half: room for 3 floats a pixel each. */
ec_result ec_atrous(const ec_device_info *device, const ec_film *film, float scale, float *const half[2], ec_error *err);

#endif
