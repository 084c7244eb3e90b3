/* How many of the light samples go to lights at infinity, and how many to lamps, where a scene has both: kernels/lib/light_share.h. */
#ifndef EC_DEVICE_LIGHT_SHARE_H
#define EC_DEVICE_LIGHT_SHARE_H

#include <stdint.h>

#include "shared/params.h"

/* That of lights at infinity, in (0, 1), a multiple of 1/256, which all that is derived from it holds exactly. params may have another one already. */
void ec_light_share_set(ec_params *params, double share);

/* Lights at infinity are chosen by so many of 2^32 random numbers, from 1 on, whatever chance their densities have. */
void ec_light_numbers_set(ec_params *params, uint32_t far);

#endif
