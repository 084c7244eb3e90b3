/* Closest hit of every path, LANES rays a packet through the binary BVH. Reads: path queue. Writes: hits. Next: shade. */
#include "../lib/film.h"
#include "../lib/queue.h"
#include "../lib/traverse_packet.h"

kernel void ec_intersect_packet(constant ec_params *params, uint seed, uint first_pixel, uint bounce, uint step,
                                global const ec_counters *counters, global const float *paths, global float *hits,
                                global const ec_bvh2_node *nodes, global const ec_tri *tris, global const ec_box *boxes, global const float *prims,
                                global const float *indices, global const float *uvs,
                                global const float *colors, global const float *materials,
                                global const float *texture_table, global const uint *texels, constant float *srgb)
{
    uint i = get_global_id(0) * LANES, wave = params->wave;
    if (i >= wave) return;
    uint left = queue_left(counters->rays[step], params->part, i);
    if (!left) return;
    lane_i active = LANE_NUMBERS < left;
    ray r = ray_make(queue_load_v3(paths, wave, EC_PATH_OX, i), queue_load_v3(paths, wave, EC_PATH_DX, i), params->scene_max);
    hit_filter filter = {{prims, indices, 0, 0, uvs, colors, materials, {texture_table, texels, srgb}}, U(0), bounce == 0};
    if (HAS(ALPHA)) {
        lane_u pixel, sample, slot = queue_load_u(paths, wave, EC_PATH_SLOT, i);
        slot_to_pixel(params, first_pixel, active ? slot : U(0), &pixel, &sample);
        filter.key = filter_key(seed, pixel, sample, bounce, false);
    }
    hit h = {active ? F(EC_HUGE) : F(-1.0f), U(EC_NO_ID), F(0.0f), F(0.0f)};
    lane_u skip = queue_load_u(paths, wave, EC_PATH_PRIM, i);
    traverse_packet(&r, &filter, nodes, tris, boxes, skip, U(EC_NO_ID), false, &h);
    queue_store_f(hits, wave, EC_HIT_PRIM, i, as_lane_f(h.prim));
    queue_store_f(hits, wave, EC_HIT_B1, i, h.b1);
    queue_store_f(hits, wave, EC_HIT_B2, i, h.b2);
}
