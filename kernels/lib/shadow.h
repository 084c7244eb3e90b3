/* A light sample becomes a shadow ray. */
#ifndef EC_LIB_SHADOW_H
#define EC_LIB_SHADOW_H

#include "light.h"
#include "medium.h"
#include "queue.h"

/* What the body that the shadow ray starts in leaves of the light; wi_z: against ns. Infinitely far no body reaches: what path
 * tracing misses is not dimmed either. */
EC_FN v3 shadow_transmittance(const geometry *g, const hit_point *h, const surface *s, const light_sample *l, lane_u medium,
                              lane_f wi_z, bool nested)
{
    lane_u between = medium_material(g, medium_towards(h, s, medium, wi_z, nested), nested);
    return medium_transmittance(g, l->is_far ? U(EC_NO_ID) : between, sqrt(v3_dot(l->towards, l->towards)));
}

/* Appends a ray from `from` to `end` to i's part of the queue, which counts counts; what is not finite is dropped and counted. It passes
 * through triangles prim and target. */
EC_FN void shadow_push(constant ec_params *params, global float *shadows, volatile global uint *counts, uint i, v3 from, v3 end, v3 arriving,
                       lane_u slot, lane_u prim, lane_u target, lane_i m, volatile global uint *invalid)
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
}

/* Where a ray ends that goes to the light that was sampled for p. */
EC_FN v3 shadow_end(v3 p, const light_sample *l)
{
    return surface_offset(v3_add(p, l->towards), l->end_error, l->end_normal, v3_negate(l->wi));
}

#endif
