/* Decides which of several coplanar faces a ray meets. Where faces lie on one another, their distances differ by rounding alone, and the closest
 * would change from ray to ray: a speckle. The host has found such faces (host/pack/coplanar.c). Once the closest hit is known, it is replaced, alike
 * for every accelerator, by the first of them that faces the ray, or else by the first that does not. In the host's order come faces with a coverage,
 * then opaque ones, then those that let light pass; within each, the file's order.
 *
 * The table has, for each triangle, the word where its list begins, or 0. A list has two counts, `opposite` and `alike`, and as many triangles: first all
 * that face the other way, which a ray that meets this one from behind meets from the front, then those that face the same way and come before it. */
#ifndef EC_LIB_COPLANAR_H
#define EC_LIB_COPLANAR_H

#include "filter.h"
#include "ray.h"

#define HAS_COPLANAR (HAS(COPLANAR) && coplanar != 0)

/* Returns the edge functions of triangle prim along a ray. */
EC_FN edges coplanar_edges(const hit_filter *f, const ray *r, lane_u prim)
{
    lane_i placed, turned = !TRUE_MASK;
    lane_u place, stored = HAS(INSTANCES) && f->g.places ? instance_find(f->g.places, prim, &placed, &place, &turned) : prim;
    quad v0 = gather_quad(f->g.prims, stored * EC_PRIM_WORDS), v1 = gather_quad(f->g.prims, stored * EC_PRIM_WORDS + 4u),
         v2 = gather_quad(f->g.prims, stored * EC_PRIM_WORDS + 8u);
    v3 p0 = v3_make(v0.a, v0.b, v0.c), p1 = v3_make(v1.a, v1.b, v1.c), p2 = v3_make(v2.a, v2.b, v2.c);
    if (HAS(INSTANCES) && f->g.places) instance_corners(f->g.places, placed, turned, place, &p0, &p1, &p2);
    if (HAS(MOTION) && f->g.motion) motion_corners(f->g.motion, f->g.time, motion_moves(f->g.motion, prim), prim, &p0, &p1, &p2);
    return edges_make(ray_vertex(r, p0), ray_vertex(r, p1), ray_vertex(r, p2));
}

/* Returns the triangle, other than `skip`, that counts as met where the ray has met `prim` (lanes m); *b1, *b2 become its barycentrics. */
EC_CALLED lane_u coplanar_first(global const uint *table, const hit_filter *f, const ray *r, lane_i m, lane_u prim, lane_u skip, lane_f *b1, lane_f *b2)
{
    lane_u at = gather_u(table, m ? prim : U(0));
    m = m & (at != 0u);
    if (!any_lane(m)) return prim;
    at = m ? at : U(0);
    lane_u opposite = gather_u(table, at), alike = gather_u(table, at + 1u);
    edges e = coplanar_edges(f, r, m ? prim : U(0));
    e.det = e.u + e.v + e.w;
    lane_u k = edges_front(r, &e) ? opposite : U(0), end = opposite + alike;
    EC_LOOP
    for (;; k = k + 1u) {
        m = m & (k < end);
        if (!any_lane(m)) return prim;
        lane_u rival = gather_u(table, m ? at + 2u + k : U(0));
        rival = m ? rival : U(0);
        e = coplanar_edges(f, r, rival);
        lane_i meets = m & edges_inside(&e) & (rival != skip);
        if (!any_lane(meets)) continue;
        lane_f inverse = 1.0f / e.det, c1 = e.v * inverse + 0.0f, c2 = e.w * inverse + 0.0f;
        meets = filter_hits(f, meets, rival, c1, c2, edges_front(r, &e));
        prim = meets ? rival : prim;
        *b1 = meets ? c1 : *b1;
        *b2 = meets ? c2 : *b2;
        m = m & !meets;
    }
}

/* Returns the lanes of m on which another face hides `target`, the triangle that the ray ends on. Other lanes may have any target. */
EC_FN lane_i coplanar_hides(global const uint *table, const hit_filter *f, const ray *r, lane_i m, lane_u target, lane_u skip)
{
    lane_f b1, b2;
    m = m & (target != EC_NO_ID);
    return m & (coplanar_first(table, f, r, m, target, skip, &b1, &b2) != target);
}

#endif
