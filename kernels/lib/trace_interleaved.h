/* The two kernels of bvh8 for structures larger than caches: a work-item has INTERLEAVE rays in flight, takes one step of each in turn, and
 * prefetches what a ray's next step reads before it turns to the next ray, so that memory answers while others are served (as group prefetching does
 * in databases: Chen, Ailamaki, Gibbons, Mowry 2004). Steps have few branches: one that is mispredicted costs all rays. Boxes and triangles are
 * tested as by bvh8_closest and bvh8_any, so the hits are the same. Motion, panes and coplanar faces are left to trace_rays.h. */
#ifndef EC_LIB_TRACE_INTERLEAVED_H
#define EC_LIB_TRACE_INTERLEAVED_H

#include "packet8.h"
#include "trace.h"

/* A ray in flight. */
typedef struct walk {
    ray8 q;
    hit8 h;
    uint i;               /* its place in the queue */
    uint skip0, skip1;    /* triangles that the ray passes through */
    uint current, depth;  /* node or leaf to visit next; depth of the stack */
    struct walk *next;    /* in the ring of rays in flight */
    lane_u key;           /* as in hit_filter */
    stack8 stack;         /* any-hit rays use its children alone */
} walk;

/* Prefetches all cache lines of a node or a block, which come from memory here. */
EC_INLINED void walk_prefetch(const accel *a, uint child)
{
    global const ec_bvh8_node *nodes = a->at[0];
    global const ec_tri8 *blocks = a->at[1];
    ulong at = child & EC_LEAF_BIT ? (ulong)(blocks + (child & ~EC_LEAF_BIT)) : (ulong)(nodes + child);
    PREFETCH(at);
    PREFETCH(at + 64u);
    PREFETCH(at + 128u);
    PREFETCH(at + 192u);
    PREFETCH(at + 192u + (child >> 31 << 6)); /* a block has one more than a node */
}

/* Starts the walk of the ray at entry i; the caller has made w->q. */
EC_INLINED void walk_begin(walk *w, uint i, uint skip0, uint skip1, float t_max)
{
    hit8 h = {t_max, EC_NO_ID, 0.0f, 0.0f};
    w->h = h;
    w->i = i;
    w->skip0 = skip0;
    w->skip1 = skip1;
    w->current = w->depth = 0;
}

/* Makes one visit on the way to the closest hit; returns true once that is known. */
EC_INLINED bool walk_closest(const accel *a, hit_filter *filter, walk *w)
{
    if (w->current & EC_LEAF_BIT) {
        if (HAS(ALPHA)) filter->key = w->key;
        leaf8(a, &w->q, filter, w->current, w->skip0, w->skip1, false, &w->h);
    } else {
        TALLY_NODE(&w->h);
        w->depth = node8_push_near(&w->q, (global const ec_bvh8_node *)a->at[0] + w->current, w->h.t, &w->stack, w->depth);
    }
    uint depth = w->depth;
    do {
        if (depth == 0) return true;
        depth--;
    } while (w->stack.near[depth] > w->h.t);
    w->depth = depth;
    w->current = w->stack.child[depth];
    walk_prefetch(a, w->current);
    return false;
}

/* Makes one visit on the way to any hit; returns true once there is one, or nothing is left to visit. */
EC_INLINED bool walk_any(const accel *a, hit_filter *filter, walk *w)
{
    if (w->current & EC_LEAF_BIT) {
        if (HAS(ALPHA)) filter->key = w->key;
        leaf8(a, &w->q, filter, w->current, w->skip0, w->skip1, true, &w->h);
        if (w->h.prim != EC_NO_ID) return true;
    } else {
        TALLY_NODE(&w->h);
        w->depth += node8_push(&w->q, (global const ec_bvh8_node *)a->at[0] + w->current, w->h.t, w->stack.child + w->depth);
    }
    if (w->depth == 0) return true;
    w->current = w->stack.child[--w->depth];
    walk_prefetch(a, w->current);
    return false;
}

/* Makes a ring of the first `count` walks, at least one, and returns the last of them. */
EC_INLINED walk *walk_ring(walk *walks, uint count)
{
    for (uint k = 0; k < count; k++) walks[k].next = walks + (k + 1 < count ? k + 1 : 0);
    return walks + count - 1;
}

/* Takes *w, which has ended, out of the ring; *w becomes `before`. Returns false if it was the only one. */
EC_INLINED bool walk_drop(walk **w, walk *before)
{
    if (*w == before) return false;
    before->next = (*w)->next;
    *w = before;
    return true;
}

EC_INLINED void walk_path(walk *w, constant ec_params *params, uint seed, uint first_pixel, global const uint *pixel_list,
                          uint bounce, global const float *paths, uint i)
{
    uint wave = params->wave;
    global const float *p = paths + i;
    w->q = ray8_make(p[EC_PATH_OX * wave], p[EC_PATH_OY * wave], p[EC_PATH_OZ * wave], p[EC_PATH_DX * wave],
                     p[EC_PATH_DY * wave], p[EC_PATH_DZ * wave], params->scene_max);
    walk_begin(w, i, as_uint(p[EC_PATH_PRIM * wave]), EC_NO_ID, EC_HUGE);
    if (HAS(ALPHA)) {
        lane_u pixel, sample;
        slot_to_pixel(params, first_pixel, pixel_list, U(as_uint(p[EC_PATH_SLOT * wave])), &pixel, &sample);
        w->key = filter_key(seed, pixel, sample, bounce, false);
    }
}

EC_INLINED void walk_store(const walk *w, uint wave, global float *hits)
{
    hits[EC_HIT_PRIM * wave + w->i] = as_float(w->h.prim);
    hits[EC_HIT_B1 * wave + w->i] = w->h.b1;
    hits[EC_HIT_B2 * wave + w->i] = w->h.b2;
#ifdef PROBE
    hits[EC_HIT_T * wave + w->i] = w->h.t;
    hits[EC_HIT_NODES * wave + w->i] = as_float(w->h.nodes);
    hits[EC_HIT_TESTS * wave + w->i] = as_float(w->h.tests);
#endif
}

/* Finds the closest hits of eight camera rays from entry i on, or of the `left` that there are. */
EC_INLINED void camera_rays(uint i, uint left, constant ec_params *params INTERSECT_PARAMETERS(EC_PARAMETER))
{
    uint wave = params->wave;
    lane_i on = LANE_NUMBERS < left;
    v3 o = queue_load_v3(paths, wave, EC_PATH_OX, i), d = queue_load_v3(paths, wave, EC_PATH_DX, i);
    o = v3_select(on, o, v3_make(F(o.x.s0), F(o.y.s0), F(o.z.s0))); /* lanes that are off take the first ray */
    d = v3_select(on, d, v3_make(F(d.x.s0), F(d.y.s0), F(d.z.s0)));
    hit_filter filter = {FILTER_GEOMETRY, U(0), true, 0};
    if (HAS(ALPHA)) {
        lane_u slot = queue_load_u(paths, wave, EC_PATH_SLOT, i), pixel, sample;
        slot_to_pixel(params, first_pixel, pixel_list, on ? slot : U(0), &pixel, &sample);
        filter.key = filter_key(seed, pixel, sample, bounce, false);
    }
    const accel a = ACCEL_ARGUMENTS;
    hits8 h = {on ? F(EC_HUGE) : F(-1.0f), U(EC_NO_ID), F(0.0f), F(0.0f)};
    lane_u skip = queue_load_u(paths, wave, EC_PATH_PRIM, i);
    packet8 p;
    p.r = ray_make(o, d, params->scene_max);
    if (packet8_make(&p, params->scene_max)) packet8_closest(&a, &p, &filter, skip, &h);
    else packet8_each(&a, &p, &filter, 0, mask_bits8(on), skip, &h);
    uint bits = mask_bits8(on);
    queue_push_f(hits, wave, EC_HIT_PRIM, i, as_lane_f(h.prim), bits);
    queue_push_f(hits, wave, EC_HIT_B1, i, h.b1, bits);
    queue_push_f(hits, wave, EC_HIT_B2, i, h.b2, bits);
#ifdef PROBE
    queue_push_f(hits, wave, EC_HIT_T, i, h.t, bits);
    queue_push_f(hits, wave, EC_HIT_NODES, i, as_lane_f(U(h.nodes)), bits);
    queue_push_f(hits, wave, EC_HIT_TESTS, i, as_lane_f(U(h.tests)), bits);
#endif
}

/* Closest hit of every path. Reads: path queue. Writes: hits. Next: shade. */
EC_KERNEL(ec_intersect_bvh8, RUN, INTERSECT_PARAMETERS, QUEUED(at[step].rays))
{
    uint wave = params->wave, next = 0;
    left = min(left, RUN);
    if (bounce == 0) {
        for (; next < left; next += 8u) camera_rays(i + next, left - next, params INTERSECT_PARAMETERS(EC_ARGUMENT));
        return;
    }
    const accel a = ACCEL_ARGUMENTS;
    hit_filter filter = {FILTER_GEOMETRY, U(0), false, 0};
    walk walks[INTERLEAVE], *w = walks, *before = walk_ring(walks, min(left, (uint)INTERLEAVE));
    for (; next < left && next < INTERLEAVE; next++) walk_path(walks + next, params, seed, first_pixel, pixel_list, bounce, paths, i + next);
    for (;; before = w, w = w->next) {
        if (!walk_closest(&a, &filter, w)) continue;
        walk_store(w, wave, hits);
        if (next < left) walk_path(w, params, seed, first_pixel, pixel_list, bounce, paths, i + next++);
        else if (!walk_drop(&w, before)) return;
    }
}

EC_INLINED void walk_shadow(walk *w, constant ec_params *params, uint seed, uint first_pixel, global const uint *pixel_list,
                            uint bounce, global const float *shadows, uint i)
{
    uint wave = params->wave;
    global const float *p = shadows + i;
    w->q = ray8_make(p[EC_SHADOW_OX * wave], p[EC_SHADOW_OY * wave], p[EC_SHADOW_OZ * wave], p[EC_SHADOW_DX * wave],
                     p[EC_SHADOW_DY * wave], p[EC_SHADOW_DZ * wave], params->scene_max);
    walk_begin(w, i, as_uint(p[EC_SHADOW_PRIM * wave]), as_uint(p[EC_SHADOW_TARGET * wave]), 1.0f);
    if (HAS(ALPHA)) {
        lane_u pixel, sample;
        slot_to_pixel(params, first_pixel, pixel_list, U(slot_alone_one(as_uint(p[EC_SHADOW_SLOT * wave]))), &pixel, &sample);
        w->key = filter_key(seed, pixel, sample, bounce, true);
    }
}

EC_INLINED void walk_light(const walk *w, constant ec_params *params, uint bounce, global const float *shadows, global float *radiance)
{
    uint wave = params->wave;
    global const float *p = shadows + w->i;
    if (w->h.prim == EC_NO_ID)
        light_add_one(params, radiance, bounce + 2, as_uint(p[EC_SHADOW_SLOT * wave]), p[EC_SHADOW_LR * wave], p[EC_SHADOW_LG * wave],
                      p[EC_SHADOW_LB * wave]);
}

/* Traces shadow rays: light that nothing blocks is added to its slot. Reads: shadow queue. Writes: radiance. */
EC_KERNEL(ec_connect_bvh8, RUN, CONNECT_PARAMETERS, QUEUED(at[step].shadows))
{
    uint next = 0;
    left = min(left, RUN);
    const accel a = ACCEL_ARGUMENTS;
    hit_filter filter = {FILTER_GEOMETRY, U(0), CAMERA_SHADOWS(bounce), 0};
    walk walks[INTERLEAVE], *w = walks, *before = walk_ring(walks, min(left, (uint)INTERLEAVE));
    for (; next < left && next < INTERLEAVE; next++) walk_shadow(walks + next, params, seed, first_pixel, pixel_list, bounce, shadows, i + next);
    for (;; before = w, w = w->next) {
        if (!walk_any(&a, &filter, w)) continue;
        walk_light(w, params, bounce, shadows, radiance);
        if (next < left) walk_shadow(w, params, seed, first_pixel, pixel_list, bounce, shadows, i + next++);
        else if (!walk_drop(&w, before)) return;
    }
}

#endif
