#include "jobs/denoise_choice.h"

#include "jobs/numbers.h"

ec_result ec_parse_denoise(const char *option, const char *value, ec_denoiser *denoiser, ec_error *err)
{
    uint32_t index = EC_DENOISER_AUTO;
    if (value) EC_TRY(ec_parse_choice(option, value, ec_denoiser_names, &index, err));
    *denoiser = (ec_denoiser)index;
    return EC_OK;
}
