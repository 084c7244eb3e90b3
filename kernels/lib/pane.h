/* Panes: thin walls (KHR_materials_transmission without a volume) that are smooth, so that what passes goes straight on. A shadow ray
 * goes on with it, and light behind panes is looked for as if they were not there, but for what they take away. A path that has
 * passed some keeps the point where light was last looked for and the density of its direction there: what it meets is weighed
 * against light sampling from that point, and nothing is counted twice. */
#ifndef EC_LIB_PANE_H
#define EC_LIB_PANE_H

#include "bsdf.h"

#define EC_PANES_MOST 1024u /* in the way of one shadow ray: 0.04 of it reflected by each would leave 1e-18 */

/* How many panes a shadow ray may pass: each is a vertex, as for a path, but not for Whitted's. */
EC_FN uint panes_most(constant ec_params *params, uint bounce)
{
    uint left = params->max_depth - min((bounce & ~EC_LIGHT_BOUNCE) + 2u, params->max_depth);
    return params->panes_count ? min(left, EC_PANES_MOST) : EC_PANES_MOST;
}

/* What goes straight on of light that comes along wo: the value of that single direction, as bsdf_sample weighs it. */
EC_FN v3 bsdf_straight(const bsdf *b)
{
    lane_i straight = b->facets.smooth & !b->refracts & (b->wo.z > 0.0f);
    return v3_select(straight, bsdf_passing(b, b->wo.z), v3_zero());
}

/* A shadow ray along d (any length) has met triangle prim (lanes m): what is left of its light, 0 where nothing passes. *o becomes
 * where it goes on. */
EC_FN v3 pane_pass(const geometry *g, lane_i m, lane_u prim, lane_f b1, lane_f b2, v3 d, v3 *o)
{
    prim = m ? prim : U(0);
    lane_i may = m & ((as_lane_u(gather_f(g->prims, prim * EC_PRIM_WORDS + 11u)) & EC_PRIM_PANE) != 0u);
    if (!any_lane(may)) return v3_zero();
    v3 wo = v3_negate(v3_normalize(d));
    hit_point h = hit_point_make(g, prim, b1, b2);
    surface s;
    surface_place(&h, wo, &s);
    surface_frame(g, &h, may, wo, &s);
    surface_material(g, &h, may, &s);
    bsdf b = bsdf_make(&s, surface_to_local(&s, wo), false);
    *o = v3_select(may, surface_offset(s.p, s.p_error, s.ng, d), *o);
    return v3_select(may, bsdf_straight(&b), v3_zero());
}

#endif
