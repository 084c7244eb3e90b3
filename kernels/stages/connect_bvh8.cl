/* Shadow rays, one a work-item through the 8-wide BVH: light that nothing blocks is added to its slot. Reads: shadow queue.
 * Writes: radiance. */
#include "../lib/film.h"
#include "../lib/queue.h"
#include "../lib/traverse_bvh8.h"

kernel void ec_connect_bvh8(constant ec_params *params, uint seed, uint first_pixel, uint bounce, uint step,
                            global const ec_counters *counters, volatile global uint *invalid,
                            global const float *shadows, global float *radiance, global const ec_bvh8_node *nodes,
                            global const ec_tri8 *blocks, global const ec_box8 *boxes, global const float *prims, global const float *indices, global const float *uvs,
                                global const float *colors,
                            global const float *materials, global const float *texture_table,
                            global const uint *texels, constant float *srgb)
{
    uint i = get_global_id(0), wave = params->wave;
    if (i >= wave || !queue_left(counters->shadows[step], params->part, i)) return;
    global const float *p = shadows + i;
    ray8 q = ray8_make(p[EC_SHADOW_OX * wave], p[EC_SHADOW_OY * wave], p[EC_SHADOW_OZ * wave], p[EC_SHADOW_DX * wave],
                       p[EC_SHADOW_DY * wave], p[EC_SHADOW_DZ * wave], params->scene_max);
    uint slot = as_uint(p[EC_SHADOW_SLOT * wave]);
    hit_filter filter = {{prims, indices, 0, 0, uvs, colors, materials, {texture_table, texels, srgb}}, U(0), false};
    if (HAS(ALPHA)) {
        lane_u pixel, sample;
        slot_to_pixel(params, first_pixel, U(slot), &pixel, &sample);
        filter.key = filter_key(seed, pixel, sample, bounce, true);
    }
    hit8 h = {1.0f, EC_NO_ID, 0.0f, 0.0f};
    if (traverse8_any(&q, &filter, nodes, blocks, boxes, as_uint(p[EC_SHADOW_PRIM * wave]), as_uint(p[EC_SHADOW_TARGET * wave]), &h))
        return;
    for (uint c = 0; c < 3; c++) {
        float light = p[(EC_SHADOW_LR + c) * wave];
        radiance[c * wave + slot] += light;
    }
}
