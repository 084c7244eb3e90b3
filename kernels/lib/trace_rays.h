/* A template of the two kernels of an accelerator that traces one ray per work-item. ACCEL is its name; the including file has defined
 *
 *     void ACCEL_closest(const accel *, const ray8 *, const hit_filter *, uint skip0, uint skip1, hit8 *h);
 *     bool ACCEL_any(const accel *, const ray8 *, const hit_filter *, uint skip0, uint skip1, hit8 *h);
 *
 * On entry h->t is the largest t of interest, h->prim EC_NO_ID. Rays pass through triangles skip0 and skip1. With ACCEL_HAS_TRACE
 *
 *     void ACCEL_trace(const accel *, const ray8 *, const hit_filter *, uint skip0, uint skip1, bool any_hit, hit8 *h);
 *
 * takes the place of both. */
#include "pane.h"
#include "trace.h"

#ifdef ACCEL_HAS_TRACE
EC_INLINED void EC_CAT(ACCEL, _closest)(const accel *a, const ray8 *q, const hit_filter *filter, uint skip0, uint skip1, hit8 *h)
{
    EC_CAT(ACCEL, _trace)(a, q, filter, skip0, skip1, false, h);
}

EC_INLINED bool EC_CAT(ACCEL, _any)(const accel *a, const ray8 *q, const hit_filter *filter, uint skip0, uint skip1, hit8 *h)
{
    EC_CAT(ACCEL, _trace)(a, q, filter, skip0, skip1, true, h);
    return h->prim != EC_NO_ID;
}
#endif

EC_INLINED void EC_CAT(ACCEL, _settle)(global const uint *coplanar, const hit_filter *filter, const ray8 *q, uint skip, hit8 *h)
{
    lane_f b1 = F(h->b1), b2 = F(h->b2);
    h->prim = coplanar_first(coplanar, filter, &q->r, U(h->prim) != EC_NO_ID, U(h->prim), U(skip), &b1, &b2).s0;
    h->b1 = b1.s0;
    h->b2 = b2.s0;
}

/* Closest hit of every path. Reads: path queue. Writes: hits. Next: shade. */
EC_RUN_KERNEL(EC_CAT(ec_intersect_, ACCEL), INTERSECT_PARAMETERS, QUEUED(at[step].rays))
{
    uint wave = params->wave;
    global const float *p = paths + i;
    ray8 q = ray8_make(p[EC_PATH_OX * wave], p[EC_PATH_OY * wave], p[EC_PATH_OZ * wave], p[EC_PATH_DX * wave],
                       p[EC_PATH_DY * wave], p[EC_PATH_DZ * wave], params->scene_max);
    hit_filter filter = {FILTER_GEOMETRY, U(0), bounce == 0, 0};
    if (HAS_TIMES) filter.g.time = F(times[as_uint(p[EC_PATH_SLOT * wave])]);
    if (HAS(ALPHA)) {
        lane_u pixel, sample;
        slot_to_pixel(params, first_pixel, pixel_list, U(as_uint(p[EC_PATH_SLOT * wave])), &pixel, &sample);
        filter.key = filter_key(seed, pixel, sample, bounce, false);
    }
    const accel a = ACCEL_ARGUMENTS;
    hit8 h = {EC_HUGE, EC_NO_ID, 0.0f, 0.0f};
    uint skip = as_uint(p[EC_PATH_PRIM * wave]);
    EC_CAT(ACCEL, _closest)(&a, &q, &filter, skip, EC_NO_ID, &h);
    if (HAS_COPLANAR) EC_CAT(ACCEL, _settle)(coplanar, &filter, &q, skip, &h);
    hits[EC_HIT_PRIM * wave + i] = as_float(h.prim);
    hits[EC_HIT_B1 * wave + i] = h.b1;
    hits[EC_HIT_B2 * wave + i] = h.b2;
#ifdef PROBE
    hits[EC_HIT_T * wave + i] = h.t;
    hits[EC_HIT_NODES * wave + i] = as_float(h.nodes);
    hits[EC_HIT_TESTS * wave + i] = as_float(h.tests);
#endif
}

/* Traces shadow rays: light that nothing blocks is added to its slot. Reads: shadow queue. Writes: radiance. */
EC_RUN_KERNEL(EC_CAT(ec_connect_, ACCEL), CONNECT_PARAMETERS, QUEUED(at[step].shadows))
{
    uint wave = params->wave;
    global const float *p = shadows + i;
    ray8 q = ray8_make(p[EC_SHADOW_OX * wave], p[EC_SHADOW_OY * wave], p[EC_SHADOW_OZ * wave], p[EC_SHADOW_DX * wave],
                       p[EC_SHADOW_DY * wave], p[EC_SHADOW_DZ * wave], params->scene_max);
    uint word = as_uint(p[EC_SHADOW_SLOT * wave]), slot = slot_alone_one(word);
    lane_i panes = !TRUE_MASK;
    hit_filter filter = {FILTER_GEOMETRY, U(0), CAMERA_SHADOWS(bounce), HAS(PANES) ? &panes : 0};
    if (HAS_TIMES) filter.g.time = F(times[slot]);
    if (HAS(ALPHA)) {
        lane_u pixel, sample;
        slot_to_pixel(params, first_pixel, pixel_list, U(slot), &pixel, &sample);
        filter.key = filter_key(seed, pixel, sample, bounce, true);
    }
    const accel a = ACCEL_ARGUMENTS;
    hit8 h = {1.0f, EC_NO_ID, 0.0f, 0.0f};
    uint skip = as_uint(p[EC_SHADOW_PRIM * wave]), target = as_uint(p[EC_SHADOW_TARGET * wave]);
    if (EC_CAT(ACCEL, _any)(&a, &q, &filter, skip, target, &h)) return;
    if (HAS_COPLANAR && any_lane(coplanar_hides(coplanar, &filter, &q.r, TRUE_MASK, U(target), U(skip)))) return;
    v3 light = v3_make(F(p[EC_SHADOW_LR * wave]), F(p[EC_SHADOW_LG * wave]), F(p[EC_SHADOW_LB * wave]));
    lane_u medium = U(0);
    v3 passed = v3_splat(F(1.0f));
    if (HAS_SHADOW_MEDIUM) {
        medium = U(as_uint(p[EC_SHADOW_MEDIUM * wave]));
        passed = v3_make(F(p[EC_SHADOW_TR * wave]), F(p[EC_SHADOW_TG * wave]), F(p[EC_SHADOW_TB * wave]));
    }
    pane_walk w = pane_walk_make(q.r.o, light, medium, passed);
    if (HAS(PANES) && any_lane(panes)) { /* only panes are in the way: passes one after the other */
        geometry g = {prims,  indices, normals,      tangents, uvs, colors, materials, {texture_table, texels, srgb},
                      places, motion,  filter.g.time};
        v3 end = v3_add(q.r.o, q.r.d);
        filter.panes = 0;
        for (uint more = panes_most(params, bounce);; more--) {
            EC_CAT(ACCEL, _closest)(&a, &q, &filter, skip, target, &h);
            if (h.prim == EC_NO_ID) break;
            if (HAS_COPLANAR) EC_CAT(ACCEL, _settle)(coplanar, &filter, &q, skip, &h);
            pane_pass(params, &g, TRUE_MASK, U(h.prim), F(h.b1), F(h.b2), q.r.d, &w);
            if (!more || !any_lane(pane_is_lit(&w))) return;
            v3 d = v3_sub(end, w.o);
            q = ray8_make(w.o.x.s0, w.o.y.s0, w.o.z.s0, d.x.s0, d.y.s0, d.z.s0, params->scene_max);
            skip = h.prim;
            h.t = 1.0f;
            h.prim = EC_NO_ID;
        }
        w.light = pane_walk_end(params, &g, &w, HAS_SHADOW_MEDIUM ? F(p[EC_SHADOW_FAR * wave]) != 0.0f : !TRUE_MASK, end);
    }
    light_add_one(params, radiance, bounce + 2, word, w.light.x.s0, w.light.y.s0, w.light.z.s0);
}
