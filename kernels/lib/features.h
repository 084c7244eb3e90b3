/* First-hit features and layers of the first surface into the slots of a wave. */
#ifndef EC_LIB_FEATURES_H
#define EC_LIB_FEATURES_H

#include "slot_layers.h"
#include "surface.h"

EC_FN void scatter_v3(global float *out, uint wave, lane_u slot, v3 v, uint bits)
{
    scatter_f(out, slot, v.x, bits);
    scatter_f(out + wave, slot, v.y, bits);
    scatter_f(out + 2 * wave, slot, v.z, bits);
}

/* What the ray from o has found on the lanes of m: those of `found` a surface, the others nothing. */
EC_FN void store_features(constant ec_params *params, global float *aov, lane_u slot, v3 o, const surface *s, lane_i found, lane_i m)
{
    uint wave = params->wave, bits = mask_bits(m);
    v3 way = v3_sub(s->p, o);
    lane_f nothing = F(0.0f);
    scatter_v3(aov, wave, slot, v3_select(found, s->base, v3_zero()), bits);
    scatter_v3(aov + 3 * wave, wave, slot, v3_select(found, s->ns, v3_zero()), bits);
    scatter_f(aov + 6 * wave, slot, found ? sqrt(v3_dot(way, way)) : nothing, bits);
    scatter_f(aov + 7 * wave, slot, found ? F(1.0f) : nothing, bits);
}

EC_FN void store_layer(constant ec_params *params, global float *radiance, uint layer, lane_u slot, v3 v, uint bits)
{
    if (layer) scatter_add_3(layer_at(params, radiance, layer), params->wave, slot, v.x, v.y, v.z, bits);
}

/* Of the first surface, on the lanes of `found`. */
EC_FN void store_surface_layers(constant ec_params *params, global float *radiance, lane_u slot, const hit_point *h, const surface *s, lane_i found)
{
    uint bits = mask_bits(found);
    v3 centre = v3_make(F(params->scene_centre[0]), F(params->scene_centre[1]), F(params->scene_centre[2]));
    store_layer(params, radiance, params->layer_of[EC_LAYER_POSITION], slot, v3_add(s->p, centre), bits);
    store_layer(params, radiance, params->layer_of[EC_LAYER_UV], slot, v3_make(h->uv.a, h->uv.b, F(0.0f)), bits);
}

#endif
