/* --denoise of renders and merges: parses what is asked for, and finds whether it is available. */
#ifndef EC_JOBS_DENOISE_CHOICE_H
#define EC_JOBS_DENOISE_CHOICE_H

#include "base/error.h"
#include "film/denoiser.h"

/* Parses the option's value; NULL (no value) means auto. */
ec_result ec_parse_denoise(const char *option, const char *value, ec_denoiser *denoiser, ec_error *err);

/* Finds the denoiser before the first sample, so that an hour's render does not end without what was asked for. Notes if eclat's own filter replaces
 * the library. *found: as of ec_denoiser_find; EC_DENOISER_NONE if nothing is asked for. */
ec_result ec_require_denoiser(ec_denoiser asked, ec_denoiser *found, const ec_log *log, ec_error *err);

#endif
