/* Closest hit of every path, one ray a work-item through the 8-wide BVH. Reads: path queue. Writes: hits. Next: shade. */
#include "../lib/film.h"
#include "../lib/queue.h"
#include "../lib/traverse_bvh8.h"

kernel void ec_intersect_bvh8(constant ec_params *params, uint seed, uint first_pixel, uint bounce, uint step,
                              global const ec_counters *counters, global const float *paths, global float *hits,
                              global const ec_bvh8_node *nodes, global const ec_tri8 *blocks, global const ec_box8 *boxes, global const float *prims,
                              global const float *indices, global const float *uvs,
                                global const float *colors, global const float *materials,
                              global const float *texture_table, global const uint *texels, constant float *srgb)
{
    uint i = get_global_id(0), wave = params->wave;
    if (i >= wave || !queue_left(counters->rays[step], params->part, i)) return;
    global const float *p = paths + i;
    ray8 q = ray8_make(p[EC_PATH_OX * wave], p[EC_PATH_OY * wave], p[EC_PATH_OZ * wave], p[EC_PATH_DX * wave],
                       p[EC_PATH_DY * wave], p[EC_PATH_DZ * wave], params->scene_max);
    hit_filter filter = {{prims, indices, 0, 0, uvs, colors, materials, {texture_table, texels, srgb}}, U(0), bounce == 0};
    if (HAS(ALPHA)) {
        lane_u pixel, sample;
        slot_to_pixel(params, first_pixel, U(as_uint(p[EC_PATH_SLOT * wave])), &pixel, &sample);
        filter.key = filter_key(seed, pixel, sample, bounce, false);
    }
    hit8 h = {EC_HUGE, EC_NO_ID, 0.0f, 0.0f};
    traverse8_closest(&q, &filter, nodes, blocks, boxes, as_uint(p[EC_PATH_PRIM * wave]), EC_NO_ID, &h);
    hits[EC_HIT_PRIM * wave + i] = as_float(h.prim);
    hits[EC_HIT_B1 * wave + i] = h.b1;
    hits[EC_HIT_B2 * wave + i] = h.b2;
}
