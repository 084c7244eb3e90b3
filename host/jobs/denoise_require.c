#include "denoise/denoise.h"
#include "jobs/denoise_choice.h"

ec_result ec_require_denoiser(ec_denoiser asked, ec_denoiser *found, const ec_log *log, ec_error *err)
{
    *found = EC_DENOISER_NONE;
    if (asked == EC_DENOISER_NONE) return EC_OK;
    EC_TRY(ec_denoiser_find(asked, found, err));
    if (asked == EC_DENOISER_AUTO && *found == EC_DENOISER_ATROUS)
        ec_note(log, "Intel's Open Image Denoise is not installed (version 2 of the system's package, or 'pip install pyoidn'); --denoise uses eclat's own filter, which leaves more noise");
    return EC_OK;
}
