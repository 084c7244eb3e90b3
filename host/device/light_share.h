/* Divides light samples between lights at infinity and lamps, where a scene has both: kernels/lib/light_share.h. */
#ifndef EC_DEVICE_LIGHT_SHARE_H
#define EC_DEVICE_LIGHT_SHARE_H

#include <stdint.h>

#include "shared/params.h"

/* Sets the share of lights at infinity, in (0, 1), a multiple of 1/256, by which all that is derived from it is exact. params may have another one
 * already. */
void ec_light_share_set(ec_params *params, double share);

/* Lets so many of 2^32 random numbers, at least 1, choose lights at infinity, whatever chance their densities have. */
void ec_light_numbers_set(ec_params *params, uint32_t far);

#endif
