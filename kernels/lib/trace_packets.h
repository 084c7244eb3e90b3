/* A template of the two kernels of an accelerator that traces packets of LANES rays. ACCEL is its name; the including file has defined
 *
 *     void ACCEL_trace(const accel *, const ray *, const hit_filter *, lane_u skip0, lane_u skip1, bool any_hit, hit *h);
 *
 * On entry h->t is the largest t of interest (negative: lane off), h->prim EC_NO_ID. */
#include "pane.h"
#include "sort_rays.h"
#include "trace.h"

#define SORTS (LANES > 1 && sorts)

/* Closest hit of every path. Reads: path queue. Writes: hits. Next: shade. */
EC_KERNEL(EC_CAT(ec_intersect_, ACCEL), LANES, INTERSECT_PARAMETERS, QUEUED(at[step].rays))
{
    uint wave = params->wave;
    uint order[EC_ORDERED];
    uint count = item_rays(left, paths, wave, params->part, EC_PATH_OX, EC_PATH_DX, i, SORTS, order);
    const accel a = ACCEL_ARGUMENTS;
    for (uint k = 0; k < count; k += LANES) {
        lane_i active = LANE_NUMBERS < count - k;
        queue_packet at = {i + k, SORTS, SORTS ? LANE_LOAD(order + k) : U(0)};
        ray r = ray_make(packet_load_v3(paths, wave, EC_PATH_OX, &at), packet_load_v3(paths, wave, EC_PATH_DX, &at),
                         params->scene_max);
        hit_filter filter = {FILTER_GEOMETRY, U(0), bounce == 0, 0};
        lane_u slot = packet_load_u(paths, wave, EC_PATH_SLOT, &at);
        slot = active ? slot : U(0);
        if (HAS_TIMES) filter.g.time = gather_f(times, slot);
        if (HAS(ALPHA)) {
            lane_u pixel, sample;
            slot_to_pixel(params, first_pixel, pixel_list, slot, &pixel, &sample);
            filter.key = filter_key(seed, pixel, sample, bounce, false);
        }
        hit h = {active ? F(EC_HUGE) : F(-1.0f), U(EC_NO_ID), F(0.0f), F(0.0f)};
        lane_u skip = packet_load_u(paths, wave, EC_PATH_PRIM, &at);
        EC_CAT(ACCEL, _trace)(&a, &r, &filter, skip, U(EC_NO_ID), false, &h);
        if (HAS_COPLANAR) h.prim = coplanar_first(coplanar, &filter, &r, active & (h.prim != EC_NO_ID), h.prim, skip, &h.b1, &h.b2);
        uint bits = mask_bits(active);
        packet_store_f(hits, wave, EC_HIT_PRIM, &at, as_lane_f(h.prim), bits);
        packet_store_f(hits, wave, EC_HIT_B1, &at, h.b1, bits);
        packet_store_f(hits, wave, EC_HIT_B2, &at, h.b2, bits);
#ifdef PROBE
        packet_store_f(hits, wave, EC_HIT_T, &at, h.t, bits);
        packet_store_f(hits, wave, EC_HIT_NODES, &at, as_lane_f(U(h.nodes)), bits);
        packet_store_f(hits, wave, EC_HIT_TESTS, &at, as_lane_f(U(h.tests)), bits);
#endif
    }
}

/* Traces shadow rays: light that nothing blocks is added to its slot. Reads: shadow queue. Writes: radiance. */
EC_KERNEL(EC_CAT(ec_connect_, ACCEL), LANES, CONNECT_PARAMETERS, QUEUED(at[step].shadows))
{
    uint wave = params->wave;
    uint order[EC_ORDERED];
    uint count = item_rays(left, shadows, wave, params->part, EC_SHADOW_OX, EC_SHADOW_DX, i, SORTS, order);
    const accel a = ACCEL_ARGUMENTS;
    for (uint k = 0; k < count; k += LANES) {
        lane_i active = LANE_NUMBERS < count - k;
        queue_packet at = {i + k, SORTS, SORTS ? LANE_LOAD(order + k) : U(0)};
        ray r = ray_make(packet_load_v3(shadows, wave, EC_SHADOW_OX, &at), packet_load_v3(shadows, wave, EC_SHADOW_DX, &at),
                         params->scene_max);
        lane_u word = packet_load_u(shadows, wave, EC_SHADOW_SLOT, &at), slot = active ? slot_alone(word) : U(0);
        lane_i panes = !TRUE_MASK;
        hit_filter filter = {FILTER_GEOMETRY, U(0), CAMERA_SHADOWS(bounce), HAS(PANES) ? &panes : 0};
        if (HAS_TIMES) filter.g.time = gather_f(times, slot);
        if (HAS(ALPHA)) {
            lane_u pixel, sample;
            slot_to_pixel(params, first_pixel, pixel_list, slot, &pixel, &sample);
            filter.key = filter_key(seed, pixel, sample, bounce, true);
        }
        hit h = {active ? F(1.0f) : F(-1.0f), U(EC_NO_ID), F(0.0f), F(0.0f)};
        lane_u skip = packet_load_u(shadows, wave, EC_SHADOW_PRIM, &at),
               target = packet_load_u(shadows, wave, EC_SHADOW_TARGET, &at);
        EC_CAT(ACCEL, _trace)(&a, &r, &filter, skip, target, true, &h);
        lane_i open = active & (h.prim == EC_NO_ID);
        if (HAS_COPLANAR) open = open & !coplanar_hides(coplanar, &filter, &r, open, target, skip);
        if (!any_lane(open)) continue;
        lane_u medium = medium_air(MEDIA_NESTED(params));
        v3 passed = v3_splat(F(1.0f));
        if (HAS_SHADOW_MEDIUM) {
            medium = open ? packet_load_u(shadows, wave, EC_SHADOW_MEDIUM, &at) : medium;
            passed = packet_load_v3(shadows, wave, EC_SHADOW_TR, &at);
        }
        pane_walk w = pane_walk_make(r.o, packet_load_v3(shadows, wave, EC_SHADOW_LR, &at), medium, passed);
        if (HAS(PANES)) { /* only panes are in the way: passes one after the other */
            geometry g = {prims,  indices, normals,      tangents,
                          uvs,    colors,  materials,    {texture_table, texels, srgb},
                          places, motion,  filter.g.time};
            v3 end = v3_add(r.o, r.d);
            lane_i walks = open & panes, is_far = !TRUE_MASK;
            filter.panes = 0;
            for (uint more = panes_most(params, bounce); any_lane(walks); more--) {
                h.t = walks ? F(1.0f) : F(-1.0f);
                h.prim = U(EC_NO_ID);
                EC_CAT(ACCEL, _trace)(&a, &r, &filter, skip, target, false, &h);
                walks = walks & (h.prim != EC_NO_ID);
                if (!any_lane(walks)) break;
                if (HAS_COPLANAR) h.prim = coplanar_first(coplanar, &filter, &r, walks, h.prim, skip, &h.b1, &h.b2);
                pane_pass(params, &g, walks, h.prim, h.b1, h.b2, r.d, &w);
                if (!more) pane_block(walks, &w);
                walks = walks & pane_is_lit(&w);
                r = ray_make(w.o, v3_sub(end, w.o), params->scene_max);
                skip = walks ? h.prim : skip;
            }
            if (HAS_SHADOW_MEDIUM) is_far = packet_load_f(shadows, wave, EC_SHADOW_FAR, &at) != 0.0f;
            w.light = pane_walk_end(params, &g, &w, is_far, end);
        }
        radiance_add(radiance_of(params, radiance, bounce + 2), wave, slot, w.light, open, invalid + EC_STAGE_CONNECT);
        if (HAS(LAYERS)) layers_add(params, radiance, bounce + 2, slot, slot_group(word), w.light, open);
    }
}
