/* Attenuation of unscattered light by bodies, and by fog, which fills the ball about the scene except for its bodies. */
#ifndef EC_LIB_FOG_H
#define EC_LIB_FOG_H

#include "../shared/params.h"
#include "medium.h"

/* Returns how many of `length` metres from o along d lie in the fog, which fills the ball about the scene; *from: where they begin. */
EC_FN lane_f fog_span(constant ec_params *params, v3 o, v3 d, lane_f length, lane_f *from)
{
    const float radius = params->scene_radius;
    lane_f middle = -v3_dot(o, d);
    v3 off = v3_fma(d, middle, o);
    lane_f reach = sqrt(max(fma(F(radius), F(radius), -v3_dot(off, off)), F(0.0f)));
    *from = max(middle - reach, F(0.0f));
    return max(min(middle + reach, length) - *from, F(0.0f));
}

/* Returns the transmittance of fog over `length` metres from p along wi, on the lanes m; elsewhere 1. */
EC_FN lane_f fog_leaves(constant ec_params *params, lane_i m, v3 p, v3 wi, lane_f length)
{
    lane_f from, span = fog_span(params, p, wi, length, &from);
    return m ? exp_negative(-params->fog[0] * span) : F(1.0f);
}

/* Returns the transmittance of a medium over `length` metres from p along wi. Towards infinity (lanes is_far) bodies absorb nothing, as for paths
 * that miss the scene. */
EC_FN v3 medium_leaves(constant ec_params *params, const geometry *g, lane_u medium, bool nested, lane_i is_far, v3 p, v3 wi, lane_f length)
{
    v3 left = v3_splat(F(1.0f));
    if (HAS(ABSORPTION)) left = medium_transmittance(g, is_far ? U(EC_NO_ID) : medium_material(g, medium, nested), length);
    if (HAS(FOG) && params->fog[0] > 0.0f)
        left = v3_scale(left, fog_leaves(params, is_far | medium_is_air(medium, nested), p, wi, is_far ? F(EC_HUGE) : length));
    return left;
}

#endif
