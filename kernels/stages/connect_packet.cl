/* Shadow rays, LANES a packet: light that nothing blocks is added to its slot. Reads: shadow queue. Writes: radiance. */
#include "../lib/film.h"
#include "../lib/queue.h"
#include "../lib/traverse_packet.h"

kernel void ec_connect_packet(constant ec_params *params, uint seed, uint first_pixel, uint bounce, uint step,
                              global const ec_counters *counters, volatile global uint *invalid,
                              global const float *shadows, global float *radiance, global const ec_bvh2_node *nodes,
                              global const ec_tri *tris, global const ec_box *boxes, global const float *prims, global const float *indices, global const float *uvs,
                                global const float *colors,
                              global const float *materials, global const float *texture_table,
                              global const uint *texels, constant float *srgb)
{
    uint i = get_global_id(0) * LANES, wave = params->wave;
    if (i >= wave) return;
    uint left = queue_left(counters->shadows[step], params->part, i);
    if (!left) return;
    lane_i active = LANE_NUMBERS < left;
    ray r = ray_make(queue_load_v3(shadows, wave, EC_SHADOW_OX, i), queue_load_v3(shadows, wave, EC_SHADOW_DX, i),
                     params->scene_max);
    lane_u slot = queue_load_u(shadows, wave, EC_SHADOW_SLOT, i);
    slot = active ? slot : U(0);
    hit_filter filter = {{prims, indices, 0, 0, uvs, colors, materials, {texture_table, texels, srgb}}, U(0), false};
    if (HAS(ALPHA)) {
        lane_u pixel, sample;
        slot_to_pixel(params, first_pixel, slot, &pixel, &sample);
        filter.key = filter_key(seed, pixel, sample, bounce, true);
    }
    hit h = {active ? F(1.0f) : F(-1.0f), U(EC_NO_ID), F(0.0f), F(0.0f)};
    traverse_packet(&r, &filter, nodes, tris, boxes, queue_load_u(shadows, wave, EC_SHADOW_PRIM, i),
                    queue_load_u(shadows, wave, EC_SHADOW_TARGET, i), true, &h);
    lane_i open = active & (h.prim == EC_NO_ID);
    if (any_lane(open))
        radiance_add(radiance, wave, slot, queue_load_v3(shadows, wave, EC_SHADOW_LR, i), open, invalid + EC_STAGE_CONNECT);
}
