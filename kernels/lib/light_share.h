/* Divides light sampling between lights at infinity and lamps. The table of lights gives half of its numbers to each; random numbers are stretched to
 * these halves from the shares that they should have. */
#ifndef EC_LIB_LIGHT_SHARE_H
#define EC_LIB_LIGHT_SHARE_H

#include "../shared/params.h"
#include "../shared/scene_buffers.h"
#include "choice.h"

EC_FN lane_u light_share_number(constant ec_params *params, lane_u r)
{
    if (!HAS_FAR_AND_LAMPS || !params->far_numbers) return r;
    lane_i far = r < params->far_numbers;
    lane_u high = far ? U(params->far_stretch[0]) : U(params->lamp_stretch[0]), low = far ? U(params->far_stretch[1]) : U(params->lamp_stretch[1]);
    lane_u number = choice_stretch(far ? r : r - params->far_numbers, high, low, r) >> 1;
    return far ? number : (number | 0x80000000u);
}

/* Returns the probability of a light over that of the table. */
EC_FN lane_f light_share_scale(constant ec_params *params, lane_u kind)
{
    if (!HAS_FAR_AND_LAMPS || !params->far_numbers) return F(1.0f);
    lane_u type = kind & EC_LIGHT_KIND_MASK;
    return ((type == EC_KIND_ENVIRONMENT) | (type == EC_KIND_DIRECTIONAL)) ? F(params->far_scale) : F(params->lamp_scale);
}
EC_FN lane_f light_share_of_lamp(constant ec_params *params) 
{
    return F(HAS_FAR_AND_LAMPS && params->far_numbers ? params->lamp_scale : 1.0f);
}

#endif
