/* Panes: thin walls (KHR_materials_transmission without a volume) that are smooth, and walls of bodies with the same index of refraction on both
 * sides, so that what passes goes straight on. A shadow ray goes on with it, and light behind panes is looked for as if they were not there, but
 * for what they and the bodies between take away. A path that has passed some keeps the point where light was last looked for and the density
 * of its direction there: what it meets is weighed against light sampling from that point, and nothing is counted twice. */
#ifndef EC_LIB_PANE_H
#define EC_LIB_PANE_H

#include "bsdf.h"
#include "fog.h"

#define EC_PANES_MOST 1024u /* in the way of one shadow ray: 0.04 of it reflected by each would leave 1e-18 */

/* How many panes a shadow ray may pass: each is a vertex, as for a path, but not for Whitted's. */
EC_FN uint panes_most(constant ec_params *params, uint bounce)
{
    uint left = params->max_depth - min((bounce & ~EC_LIGHT_BOUNCE) + 2u, params->max_depth);
    return params->panes_count ? min(left, EC_PANES_MOST) : EC_PANES_MOST;
}

/* Is a wall a pane for what passes it in its single direction? flags: of its material. */
EC_FN lane_i pane_is(const bsdf *b, lane_u flags)
{
    lane_i matched = !TRUE_MASK;
    if (HAS(MATCHED)) matched = ((flags & EC_MATERIAL_MATCHED) != 0u) & (b->eta == 1.0f);
    return !b->refracts | matched;
}

/* What goes straight on of light that comes along wo: the value of that single direction, as bsdf_sample weighs it. */
EC_FN v3 bsdf_straight(const bsdf *b, lane_u flags)
{
    lane_i straight = b->facets.smooth & pane_is(b, flags) & (b->wo.z > 0.0f);
    return v3_select(straight, bsdf_passing(b, b->wo.z), v3_zero());
}

/* A shadow ray from *o along d (any length) in *medium has met triangle prim (lanes m): what is left of its light, 0 where nothing passes. It goes
 * on from *o in *medium. */
EC_FN v3 pane_pass(constant ec_params *params, const geometry *g, lane_i m, lane_u prim, lane_f b1, lane_f b2, v3 d, v3 *o, lane_u *medium)
{
    prim = m ? prim : U(0);
    lane_i may = m & ((as_lane_u(gather_f(g->prims, prim * EC_PRIM_WORDS + 11u)) & EC_PRIM_PANE) != 0u);
    if (!any_lane(may)) return v3_zero();
    v3 wo = v3_negate(v3_normalize(d));
    hit_point h = hit_point_make(g, prim, b1, b2);
    surface s;
    surface_place(&h, wo, &s);
    surface_frame(g, &h, may, wo, &s);
    const bool nested = MEDIA_NESTED(params);
    if (HAS_SHADOW_MEDIUM && nested) s.bodies = may ? *medium : U(0);
    surface_material(g, &h, may, &s);
    bsdf b = bsdf_make(&s, surface_to_local(&s, wo), false);
    v3 left = bsdf_straight(&b, as_lane_u(material_quad(g, &h, EC_WORD_emission).d));
    if (HAS_SHADOW_MEDIUM) {
        lane_u between = medium_of(&h, &s, may, *medium, nested);
        v3 way = v3_sub(s.p, *o);
        left = v3_mul(left, medium_leaves(params, g, between, nested, !TRUE_MASK, *o, v3_negate(wo), sqrt(v3_dot(way, way))));
        *medium = may ? medium_towards(&h, &s, between, F(-1.0f), nested) : *medium;
    }
    *o = v3_select(may, surface_offset(s.p, s.p_error, s.ng, d), *o);
    return v3_select(may, left, v3_zero());
}

/* What is left on the last part of its way, from o to `end`. */
EC_FN v3 pane_behind(constant ec_params *params, const geometry *g, lane_u medium, lane_i is_far, v3 o, v3 end)
{
    v3 way = v3_sub(end, o);
    lane_f length = sqrt(v3_dot(way, way));
    return medium_leaves(params, g, medium, MEDIA_NESTED(params), is_far, o, v3_scale(way, 1.0f / length), length);
}

#endif
