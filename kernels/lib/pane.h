/* Panes: thin walls (KHR_materials_transmission without a volume) that are smooth, and walls of bodies with the same index of refraction on both
 * sides, so that what passes goes straight on. Shadow rays pass them: light behind panes is sampled as if they were not there, and dimmed by them and
 * by the bodies between. A path that has passed some keeps the point of its last light sample and the density of its direction there: what it meets
 * is weighted against light sampling from that point, and nothing is counted twice. */
#ifndef EC_LIB_PANE_H
#define EC_LIB_PANE_H

#include "bsdf.h"
#include "fog.h"

#define EC_PANES_MOST 1024u /* panes in the way of one shadow ray: if each reflects 0.04, 1e-18 is left */

/* Returns how many panes a shadow ray may pass: each counts as a vertex, as for a path, but not for Whitted's integrator. */
EC_FN uint panes_most(constant ec_params *params, uint bounce)
{
    uint left = params->max_depth - min((bounce & ~EC_LIGHT_BOUNCE) + 2u, params->max_depth);
    return params->panes_count ? min(left, EC_PANES_MOST) : EC_PANES_MOST;
}

/* Returns the lanes on which what passes the wall goes straight on. flags: of its material. */
EC_FN lane_i pane_is(const bsdf *b, lane_u flags)
{
    lane_i matched = !TRUE_MASK;
    if (HAS(MATCHED)) matched = ((flags & EC_MATERIAL_MATCHED) != 0u) & (b->eta == 1.0f);
    return !b->refracts | matched;
}

/* Returns the share of light along wo that goes straight on: the value of that single direction, as bsdf_sample weights it. */
EC_FN v3 bsdf_straight(const bsdf *b, lane_u flags)
{
    lane_i straight = b->facets.smooth & pane_is(b, flags) & (b->wo.z > 0.0f);
    return v3_select(straight, bsdf_passing(b, b->wo.z), v3_zero());
}

/* A shadow ray's way through panes. The medium at its start fills all of it, unless a wall of a body (of relative index 1) is crossed. */
typedef struct pane_walk {
    v3 o;           /* origin of the rest of the ray */
    v3 light;       /* what is left of the light */
    v3 undimmed;    /* likewise, but bodies have absorbed only up to `from` */
    v3 from;        /* the last such wall that was crossed, or the start */
    lane_u medium;  /* medium from there on */
    lane_i crossed;
} pane_walk;

/* Starts at o in a medium that leaves `left` of the light if it fills all of the way. */
EC_FN pane_walk pane_walk_make(v3 o, v3 light, lane_u medium, v3 left)
{
    pane_walk w = {o, HAS_SHADOW_MEDIUM ? v3_mul(light, left) : light, light, o, medium, !TRUE_MASK};
    return w;
}

/* Crosses the wall of a body, on the lanes m: the medium between the last such wall and this one absorbs, and the next one begins. */
EC_FN void pane_cross(constant ec_params *params, const geometry *g, const hit_point *h, const surface *s, lane_i m, v3 d, pane_walk *w)
{
    const bool nested = MEDIA_NESTED(params);
    lane_u medium = medium_of(h, s, m, w->medium, nested);
    v3 way = v3_sub(s->p, w->from);
    v3 left = medium_leaves(params, g, medium, nested, !TRUE_MASK, w->from, d, sqrt(v3_dot(way, way)));
    w->undimmed = v3_select(m, v3_mul(w->undimmed, left), w->undimmed);
    w->medium = m ? medium_towards(h, s, medium, F(-1.0f), nested) : w->medium;
    w->from = v3_select(m, s->p, w->from);
    w->crossed = w->crossed | m;
}

/* Passes triangle prim, which the ray along d (any length) has met on the lanes m. Light that does not pass becomes 0. */
EC_FN void pane_pass(constant ec_params *params, const geometry *g, lane_i m, lane_u prim, lane_f b1, lane_f b2, v3 d, pane_walk *w)
{
    prim = m ? prim : U(0);
    lane_i may = m & ((as_lane_u(gather_f(g->prims, prim * EC_PRIM_WORDS + 11u)) & EC_PRIM_PANE) != 0u);
    v3 passes = v3_zero();
    if (any_lane(may)) {
        v3 wi = v3_normalize(d), wo = v3_negate(wi);
        hit_point h = hit_point_make(g, prim, b1, b2);
        surface s;
        surface_place(&h, wo, &s);
        surface_frame(g, &h, may, wo, &s);
        if (HAS_SHADOW_MEDIUM && MEDIA_NESTED(params)) s.bodies = may ? w->medium : U(0);
        surface_material(g, &h, may, &s);
        bsdf b = bsdf_make(&s, surface_to_local(&s, wo), false);
        passes = v3_select(may, bsdf_straight(&b, as_lane_u(material_quad(g, &h, EC_WORD_emission).d)), passes);
        w->o = v3_select(may, surface_offset(s.p, s.p_error, s.ng, d), w->o);
        if (HAS_SHADOW_MEDIUM && any_lane(may & s.refracts)) pane_cross(params, g, &h, &s, may & s.refracts, wi, w);
    }
    w->light = v3_select(m, v3_mul(w->light, passes), w->light);
    if (HAS_SHADOW_MEDIUM) w->undimmed = v3_select(m, v3_mul(w->undimmed, passes), w->undimmed);
}

EC_FN void pane_block(lane_i m, pane_walk *w)
{
    w->light = v3_select(m, v3_zero(), w->light);
    w->undimmed = v3_select(m, v3_zero(), w->undimmed);
}

EC_FN lane_i pane_is_lit(const pane_walk *w) { return v3_max_component(HAS_SHADOW_MEDIUM ? w->undimmed : w->light) > 0.0f; }

/* Returns the light that arrives at the end of the ray. */
EC_FN v3 pane_walk_end(constant ec_params *params, const geometry *g, const pane_walk *w, lane_i is_far, v3 end)
{
    if (!HAS_SHADOW_MEDIUM || !any_lane(w->crossed)) return w->light;
    v3 way = v3_sub(end, w->from);
    lane_f length = sqrt(v3_dot(way, way));
    v3 left = medium_leaves(params, g, w->medium, MEDIA_NESTED(params), is_far, w->from, v3_scale(way, 1.0f / length), length);
    return v3_select(w->crossed, v3_mul(w->undimmed, left), w->light);
}

#endif
