#include "film/denoiser.h"

#include <stddef.h>

const char *const ec_denoiser_names[] = {[EC_DENOISER_NONE] = "off", [EC_DENOISER_AUTO] = "auto", [EC_DENOISER_OIDN] = "oidn",
                                         [EC_DENOISER_ATROUS] = "atrous", NULL};
