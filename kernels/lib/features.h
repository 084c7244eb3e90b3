/* First-hit features and layers of the first surface into the slots of a wave. */
#ifndef EC_LIB_FEATURES_H
#define EC_LIB_FEATURES_H

#include "slot_layers.h"
#include "surface.h"

EC_FN void store_features(global float *aov, uint wave, lane_u slot, v3 albedo, v3 n, lane_f depth, lane_f alpha, uint bits)
{
    scatter_f(aov, slot, albedo.x, bits);
    scatter_f(aov + wave, slot, albedo.y, bits);
    scatter_f(aov + 2 * wave, slot, albedo.z, bits);
    scatter_f(aov + 3 * wave, slot, n.x, bits);
    scatter_f(aov + 4 * wave, slot, n.y, bits);
    scatter_f(aov + 5 * wave, slot, n.z, bits);
    scatter_f(aov + 6 * wave, slot, depth, bits);
    scatter_f(aov + 7 * wave, slot, alpha, bits);
}

EC_FN void store_layer(constant ec_params *params, global float *radiance, uint layer, lane_u slot, v3 v, uint bits)
{
    if (layer) scatter_add_3(layer_at(params, radiance, layer), params->wave, slot, v.x, v.y, v.z, bits);
}

/* Stores the layers that the first surface has, on the lanes of `found`. */
EC_FN void store_surface_layers(constant ec_params *params, global float *radiance, lane_u slot, const hit_point *h, const surface *s, lane_i found)
{
    uint bits = mask_bits(found);
    v3 centre = v3_make(F(params->scene_centre[0]), F(params->scene_centre[1]), F(params->scene_centre[2]));
    store_layer(params, radiance, params->layer_of[EC_LAYER_POSITION], slot, v3_add(s->p, centre), bits);
    store_layer(params, radiance, params->layer_of[EC_LAYER_UV], slot, v3_make(h->uv.a, h->uv.b, F(0.0f)), bits);
}

#endif
