/* A light sample becomes a shadow ray. */
#ifndef EC_LIB_SHADOW_H
#define EC_LIB_SHADOW_H

#include "fog.h"
#include "light.h"
#include "queue.h"

/* What is left of light that a sample brings to p through what the shadow ray starts in; all of it where that ray finds out on its way. */
EC_FN v3 shadow_arrives(constant ec_params *params, const geometry *g, const light_sample *l, lane_u medium, bool nested, v3 p, v3 light)
{
    if (HAS_SHADOW_MEDIUM) return light;
    return v3_mul(light, medium_leaves(params, g, medium, nested, l->is_far, p, l->wi, sqrt(v3_dot(l->towards, l->towards))));
}

/* Appends a ray from `from` to `end` to i's part of the queue, which counts counts; what is not finite is dropped and counted. It passes
 * through triangles prim and target, and starts in a medium. */
EC_FN void shadow_push(constant ec_params *params, global float *shadows, volatile global uint *counts, uint i, v3 from, v3 end, v3 arriving,
                       lane_u slot, lane_u prim, lane_u target, lane_u medium, lane_i is_far, lane_i m, volatile global uint *invalid)
{
    m = m & (v3_max_component(arriving) != 0.0f);
    lane_i finite = v3_is_finite(arriving);
    uint bad = mask_bits(m & !finite), bits = mask_bits(m & finite), wave = params->wave;
    if (bad) atomic_add(invalid, popcount(bad));
    if (!bits) return;
    uint at = queue_reserve(counts, params->part, i, popcount(bits));
    queue_push_v3(shadows, wave, EC_SHADOW_OX, at, from, bits);
    queue_push_v3(shadows, wave, EC_SHADOW_DX, at, v3_sub(end, from), bits);
    queue_push_v3(shadows, wave, EC_SHADOW_LR, at, arriving, bits);
    queue_push_f(shadows, wave, EC_SHADOW_SLOT, at, as_lane_f(slot), bits);
    queue_push_f(shadows, wave, EC_SHADOW_PRIM, at, as_lane_f(prim), bits);
    queue_push_f(shadows, wave, EC_SHADOW_TARGET, at, as_lane_f(target), bits);
    if (!HAS_SHADOW_MEDIUM) return;
    queue_push_f(shadows, wave, EC_SHADOW_MEDIUM, at, as_lane_f(medium), bits);
    queue_push_f(shadows, wave, EC_SHADOW_FAR, at, is_far ? F(1.0f) : F(0.0f), bits);
}

/* Where a ray ends that goes to the light that was sampled for p. */
EC_FN v3 shadow_end(v3 p, const light_sample *l)
{
    return surface_offset(v3_add(p, l->towards), l->end_error, l->end_normal, v3_negate(l->wi));
}

#endif
