#include "device/light_share.h"

#include <math.h>

#include "pack/distribution.h"

void ec_light_numbers_set(ec_params *p, uint32_t far)
{
    p->far_numbers = far;
    ec_stretch_words(ec_distribution_stretch(far), p->far_stretch);
    ec_stretch_words(ec_distribution_stretch(((uint64_t)1 << 32) - far), p->lamp_stretch);
}

void ec_light_share_set(ec_params *p, double share)
{
    if (p->far_numbers) p->environment_pmf /= p->far_scale;
    ec_light_numbers_set(p, (uint32_t)ldexp(share, 32));
    p->far_scale = (float)(2 * share);
    p->lamp_scale = 2 - p->far_scale;
    p->environment_pmf *= p->far_scale;
}
