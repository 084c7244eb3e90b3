/* Stores first-hit features, and layers of the first surface, in the slots of a wave. */
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

/* Returns 1 + the number of the node that a triangle belongs to, or 0 if none. parts: their count, the first step of the binary search, the first
 * triangle of each, the node of each. */
EC_FN lane_u part_node(global const uint *parts, lane_u prim)
{
    uint count = parts[0], step = parts[1];
    lane_u k = U(0);
    for (; step; step >>= 1) {
        lane_u next = k + step;
        lane_i there = next < count;
        lane_i after = gather_u(parts + 2, there ? next : k) <= prim;
        k = (there & after) ? next : k;
    }
    return gather_u(parts + 2 + count, k);
}

/* Stores the layers of the first surface on the lanes `found`. */
EC_FN void store_surface_layers(constant ec_params *params, global float *radiance, global const uint *parts, lane_u slot, lane_u prim, const hit_point *h,
                                const surface *s, lane_i found)
{
    uint bits = mask_bits(found);
    if (params->layer_ids) {
        v3 ids = v3_make(to_lane_f(part_node(parts, found ? prim : U(0))), to_lane_f(divide(h->material, EC_MATERIAL_WORDS) + 1u), F(0.0f));
        store_layer(params, radiance, params->layer_ids, slot, ids, bits);
    }
    v3 centre = v3_make(F(params->scene_centre[0]), F(params->scene_centre[1]), F(params->scene_centre[2]));
    store_layer(params, radiance, params->layer_of[EC_LAYER_POSITION], slot, v3_add(s->p, centre), bits);
    store_layer(params, radiance, params->layer_of[EC_LAYER_UV], slot, v3_make(h->uv.a, h->uv.b, F(0.0f)), bits);
}

#endif
