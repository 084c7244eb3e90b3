/* Finds what each sample sees, by going through its tile's triangles with a depth test. Reads: path queue, tiles. Writes: hits, as intersect does.
 * Next: shade_raster. The nearest wins, and of equals the lower triangle id: the lists' order does not matter. */
#include "../lib/camera.h"
#include "../lib/coplanar.h"
#include "../lib/filter.h"
#include "../lib/kernel.h"
#include "../lib/raster.h"
#include "../shared/accel.h"

/* Returns the samples that an edge function leaves inside. Top-left rule: a sample on an edge belongs to the triangle that lies on its positive
 * side, along x or, where that is level, along y. */
EC_FN lane_i raster_inside(global const float *f, lane_f value)
{
    bool owns = f[0] > 0.0f || (f[0] == 0.0f && (f[1] > 0.0f || (f[1] == 0.0f && f[2] > 0.0f)));
    return owns ? value >= 0.0f : value > 0.0f;
}
EC_FN lane_f raster_value(global const float *f, lane_f x, lane_f y) { return fma(F(f[0]), x, fma(F(f[1]), y, F(f[2]))); }

#define RASTER_PARAMETERS(DO)                                                                                                                         \
    DO(uint, seed) DO(uint, first_pixel) DO(global const uint *, pixel_list) DO(uint, path_count) DO(global const float *, paths)                     \
    DO(global float *, hits) DO(global const ec_raster_tri *, tris) DO(global const uint *, starts) DO(global const uint *, ends)                     \
    DO(global const uint *, list) DO(global const float *, prims) DO(global const float *, indices) DO(global const float *, uvs)                     \
    DO(global const float *, colors) DO(global const float *, materials) DO(global const float *, texture_table) DO(global const uint *, texels)      \
    DO(constant float *, srgb) DO(global const float *, places) DO(global const float *, motion) DO(global const float *, times)                      \
    DO(global const uint *, coplanar)

EC_KERNEL(ec_raster, LANES, RASTER_PARAMETERS, slot_entries(path_count, i))
{
    uint wave = params->wave;
    lane_u slot = LANE_NUMBERS + i, x, y, pixel, sample;
    lane_f sx, sy;
    lane_i waiting = slot < path_count, active = waiting;
    slot = waiting ? slot : U(i);
    camera_sample(params, seed, first_pixel, pixel_list, 0, slot, &x, &y, &sx, &sy);
    lane_u tile = raster_tile(params, x, y);
    hit_filter filter = {{prims, indices, 0, 0, uvs, colors, materials, {texture_table, texels, srgb}, places}, U(0), true, 0};
    if (HAS(ALPHA)) {
        slot_to_pixel(params, first_pixel, pixel_list, slot, &pixel, &sample);
        filter.key = filter_key(seed, pixel, sample, 0, false);
    }
    lane_u best = U(EC_NO_ID);
    lane_f nearest = params->orthographic ? F(-EC_HUGE) : F(0.0f), best_b1 = F(0.0f), best_b2 = F(0.0f);
    for (uint bits = mask_bits(waiting); bits; bits = mask_bits(waiting)) {
        uint tiles[LANES];
#if LANES == 1
        tiles[0] = tile;
#else
        LANE_STORE(tile, tiles);
#endif
        uint here = tiles[31u - clz(bits & -bits)];
        lane_i m = waiting & (tile == U(here));
        waiting = waiting & (tile != U(here));
        for (uint k = starts[here]; k < ends[here]; k++) {
            global const ec_raster_tri *t = tris + list[k];
            lane_f e0 = raster_value(t->edge[0], sx, sy), e1 = raster_value(t->edge[1], sx, sy),
                   e2 = raster_value(t->edge[2], sx, sy);
            lane_i in = m & raster_inside(t->edge[0], e0) & raster_inside(t->edge[1], e1) & raster_inside(t->edge[2], e2);
            if (!any_lane(in)) continue;
            lane_f sum = e0 + e1 + e2, nearness = raster_value(t->nearness, sx, sy);
            in = in & (sum > 0.0f) & (params->orthographic ? nearness < 0.0f : nearness > 0.0f) &
                 ((nearness > nearest) | ((nearness == nearest) & (U(t->prim) < best)));
            if (!any_lane(in)) continue;
            lane_f b1 = e1 / sum, b2 = e2 / sum;
            if (HAS(CULLING) || HAS(ALPHA)) {
                global const float *p = prims + t->prim * EC_PRIM_WORDS;
                point3 a = point3_make(p[0], p[1], p[2]);
                point3 n = point3_cross(point3_sub(point3_make(p[4], p[5], p[6]), a),
                                        point3_sub(point3_make(p[8], p[9], p[10]), a));
                point3 from = params->orthographic ? point3_load(params->camera_forward)
                                                   : point3_sub(a, point3_load(params->camera_origin));
                bool front = point3_dot(n, from) < 0.0f;
                in = filter_hits(&filter, in, U(t->prim), b1, b2, front ? TRUE_MASK : !TRUE_MASK);
            }
            nearest = in ? nearness : nearest;
            best = in ? U(t->prim) : best;
            best_b1 = in ? b1 : best_b1;
            best_b2 = in ? b2 : best_b2;
        }
    }
    if (HAS_COPLANAR) {
        ray r = ray_make(queue_load_v3(paths, wave, EC_PATH_OX, i), queue_load_v3(paths, wave, EC_PATH_DX, i), params->scene_max);
        best = coplanar_first(coplanar, &filter, &r, active & (best != EC_NO_ID), best, U(EC_NO_ID), &best_b1, &best_b2);
    }
    queue_store_f(hits, wave, EC_HIT_PRIM, i, as_lane_f(best));
    queue_store_f(hits, wave, EC_HIT_B1, i, best_b1);
    queue_store_f(hits, wave, EC_HIT_B2, i, best_b2);
}
