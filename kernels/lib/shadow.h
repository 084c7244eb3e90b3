/* Turns a light sample into a shadow ray. */
#ifndef EC_LIB_SHADOW_H
#define EC_LIB_SHADOW_H

#include "fog.h"
#include "light.h"
#include "queue.h"

/* The medium that a shadow ray starts in, and what it leaves of the light if it fills all of the way. */
typedef struct shadow_way {
    lane_u medium;
    v3 left;
    lane_i is_far;
} shadow_way;

/* Makes the way to light sample l for p. */
EC_FN shadow_way shadow_way_make(constant ec_params *params, const geometry *g, const light_sample *l, lane_u medium, bool nested, v3 p)
{
    shadow_way w = {medium, v3_splat(F(1.0f)), l->is_far};
    if (HAS_MEDIUM) w.left = medium_leaves(params, g, medium, nested, l->is_far, p, l->wi, sqrt(v3_dot(l->towards, l->towards)));
    return w;
}

/* Appends a ray from `from` to `end` to part `row` of the queue, whose counters are `counts`; light that is not finite is dropped and counted. The
 * ray passes through triangles prim and target. */
EC_FN void shadow_push(constant ec_params *params, global float *shadows, volatile global uint *counts, uint row, v3 from, v3 end, v3 arriving,
                       lane_u slot, lane_u prim, lane_u target, const shadow_way *way, lane_i m, volatile global uint *invalid)
{
    if (!HAS_SHADOW_MEDIUM) arriving = v3_mul(arriving, way->left);
    m = m & (v3_max_component(arriving) != 0.0f);
    lane_i finite = v3_is_finite(arriving);
    uint bad = mask_bits(m & !finite), bits = mask_bits(m & finite), wave = params->wave;
    if (bad) atomic_add(invalid, popcount(bad));
    if (!bits) return;
    uint at = queue_reserve(counts, params->part, row, bits);
    queue_push_v3(shadows, wave, EC_SHADOW_OX, at, from, bits);
    queue_push_v3(shadows, wave, EC_SHADOW_DX, at, v3_sub(end, from), bits);
    queue_push_v3(shadows, wave, EC_SHADOW_LR, at, arriving, bits);
    queue_push_f(shadows, wave, EC_SHADOW_SLOT, at, as_lane_f(slot), bits);
    queue_push_f(shadows, wave, EC_SHADOW_PRIM, at, as_lane_f(prim), bits);
    queue_push_f(shadows, wave, EC_SHADOW_TARGET, at, as_lane_f(target), bits);
    if (!HAS_SHADOW_MEDIUM) return;
    queue_push_f(shadows, wave, EC_SHADOW_MEDIUM, at, as_lane_f(way->medium), bits);
    queue_push_v3(shadows, wave, EC_SHADOW_TR, at, way->left, bits);
    queue_push_f(shadows, wave, EC_SHADOW_FAR, at, way->is_far ? F(1.0f) : F(0.0f), bits);
}

/* Returns the end of the shadow ray from p to light sample l. */
EC_FN v3 shadow_end(v3 p, const light_sample *l)
{
    return surface_offset(v3_add(p, l->towards), l->end_error, l->end_normal, v3_negate(l->wi));
}

#endif
