/* Samples one light at its centre, by Blinn-Phong, for the hits that whitted left in their queue.
 * Reads: path queue and hits. Writes: the shadow queue. Next: connect, then the next light. */
#include "../lib/blinn_phong.h"
#include "../lib/kernel.h"
#include "../lib/light_centre.h"
#include "../lib/shadow.h"

#define WHITTED_LIGHT_PARAMETERS(DO)                                                                                                                  \
    DO(uint, light) DO(uint, step) DO(volatile global ec_counters *, counters) DO(volatile global uint *, invalid) DO(global const float *, paths)    \
    DO(global const float *, hits) DO(global float *, shadows) SURFACE_PARAMETERS(DO) DO(global const float *, light_table)

EC_KERNEL(ec_whitted_light, LANES, WHITTED_LIGHT_PARAMETERS, QUEUED(at[0].rays))
{
    uint wave = params->wave;
    geometry g = {prims, indices, normals, tangents, uvs, colors, materials, {texture_table, texels, srgb}, places};
    lane_u prim = queue_load_u(hits, wave, EC_HIT_PRIM, i);
    lane_i lit = (LANE_NUMBERS < left) & (prim != EC_NO_ID);
    if (!any_lane(lit)) return;
    v3 wo = v3_negate(queue_load_v3(paths, wave, EC_PATH_DX, i)), beta = queue_load_v3(paths, wave, EC_PATH_BR, i);
    lane_u slot = queue_load_u(paths, wave, EC_PATH_SLOT, i);
    hit_point h = hit_point_make(&g, lit ? prim : U(0), queue_load_f(hits, wave, EC_HIT_B1, i),
                                 queue_load_f(hits, wave, EC_HIT_B2, i));
    surface s;
    surface_place(&h, wo, &s);
    light_sample l = light_from_centre(light_table, light, &g, lit, s.p, params->scene_radius);
    lit = lit & l.valid & (v3_dot(s.ng, l.wi) > 0.0f);
    if (!any_lane(lit)) return;
    surface_frame(&g, &h, lit, wo, &s);
    bool nested = MEDIA_NESTED(params);
    if (nested) s.bodies = lit ? queue_load_u(paths, wave, EC_PATH_MEDIUM, i) : U(0);
    surface_material(&g, &h, lit, &s);
    bsdf b = bsdf_make(&s, surface_to_local(&s, wo), false);
    v3 wi_local = surface_to_local(&s, l.wi);
    v3 f = blinn_phong_eval(&b, whitted_mirrors(&s), wi_local);
    v3 arriving = v3_mul(v3_mul(beta, f), l.radiance);
    lane_u medium = medium_air(nested);
    if (HAS_MEDIUM) {
        medium = medium_of(&h, &s, lit, queue_load_u(paths, wave, EC_PATH_MEDIUM, i), nested);
        medium = medium_towards(&h, &s, medium, wi_local.z, nested);
    }
    shadow_way way = shadow_way_make(params, &g, &l, medium, nested, s.p);
    v3 from = surface_offset(s.p, s.p_error, s.ng, l.wi);
    shadow_push(params, shadows, counters->at[step].shadows, row, from, shadow_end(s.p, &l), arriving, slot, prim, l.target, &way, lit, invalid + EC_STAGE_SHADE);
}
