/* --denoise of a render and of a merge: what is asked for, and whether it is there. */
#ifndef EC_JOBS_DENOISE_CHOICE_H
#define EC_JOBS_DENOISE_CHOICE_H

#include "base/error.h"
#include "film/denoiser.h"

/* The option's value; without one, NULL, it means auto. */
ec_result ec_parse_denoise(const char *option, const char *value, ec_denoiser *denoiser, ec_error *err);

/* Before the first sample: an hour's picture is not to end without what was asked for. A note says where eclat's own filter takes the place of the
 * library. found: as ec_denoiser_find's; EC_DENOISER_NONE where nothing is asked for. */
ec_result ec_require_denoiser(ec_denoiser asked, ec_denoiser *found, const ec_log *log, ec_error *err);

#endif
