/* Layers of a picture in the slots of a wave, three floats each, behind the samples' radiance: parts of it, or data of the first surface. */
#ifndef EC_LIB_SLOT_LAYERS_H
#define EC_LIB_SLOT_LAYERS_H

#include "queue.h"

/* A shadow ray's slot, with its light's group in the high bits. */
#define EC_SLOT_GROUP 28u
EC_FN lane_u slot_of_group(lane_u slot, lane_u group) { return HAS(LAYERS) ? slot | group << EC_SLOT_GROUP : slot; }
EC_FN lane_u slot_group(lane_u slot) { return HAS(LAYERS) ? slot >> EC_SLOT_GROUP : U(0); }
EC_FN uint slot_alone_one(uint slot) { return HAS(LAYERS) ? slot & ((1u << EC_SLOT_GROUP) - 1u) : slot; }
EC_FN lane_u slot_alone(lane_u slot) { return HAS(LAYERS) ? slot & ((1u << EC_SLOT_GROUP) - 1u) : slot; }

/* Returns where a layer begins; the first is 1. */
EC_FN global float *layer_at(constant ec_params *params, global float *radiance, uint layer)
{
    return radiance + 3 * (ulong)params->wave * layer;
}

/* Returns the layer for light of paths with so many segments; 0: it is not wanted. */
EC_FN uint layer_of_segments(constant ec_params *params, uint segments)
{
    return params->layer_of[segments > EC_DIRECT_SEGMENTS ? EC_LAYER_INDIRECT : EC_LAYER_DIRECT];
}

/* Adds light of paths with so many segments, from lights of these groups, to its layers; what is not finite is dropped. */
EC_FN void layers_add(constant ec_params *params, global float *radiance, uint segments, lane_u slot, lane_u group, v3 light, lane_i m)
{
    uint wave = params->wave, bits = mask_bits(m & v3_is_finite(light)), layer = layer_of_segments(params, segments);
    if (layer) scatter_add_3(layer_at(params, radiance, layer), wave, slot, light.x, light.y, light.z, bits);
    if (params->layer_groups)
        scatter_add_3(layer_at(params, radiance, params->layer_groups), wave, slot + group * (3u * wave), light.x, light.y, light.z, bits);
}

EC_FN void store_layer(constant ec_params *params, global float *radiance, uint layer, lane_u slot, v3 v, uint bits)
{
    if (layer) scatter_add_3(layer_at(params, radiance, layer), params->wave, slot, v.x, v.y, v.z, bits);
}

EC_FN void add_one(global float *to, uint wave, float r, float g, float b)
{
    to[0] += r;
    to[wave] += g;
    to[2 * wave] += b;
}

/* Adds light of one sample to its radiance and layers; slot: a shadow ray's, with the group. */
EC_FN void light_add_one(constant ec_params *params, global float *radiance, uint segments, uint slot, float r, float g, float b)
{
    uint wave = params->wave, group = HAS(LAYERS) ? slot >> EC_SLOT_GROUP : 0u;
    slot = slot_alone_one(slot);
    add_one(radiance_of(params, radiance, segments) + slot, wave, r, g, b);
    if (!HAS(LAYERS)) return;
    uint layer = layer_of_segments(params, segments);
    if (layer) add_one(layer_at(params, radiance, layer) + slot, wave, r, g, b);
    if (params->layer_groups) add_one(layer_at(params, radiance, params->layer_groups + group) + slot, wave, r, g, b);
}

#endif
