/* LANES rays through the binary BVH together. Wins on small scenes and coherent rays; with LANES 1 it is the ordinary GPU
 * kernel. */
#ifndef EC_LIB_TRAVERSE_PACKET_H
#define EC_LIB_TRAVERSE_PACKET_H

#include "../shared/accel.h"
#include "filter.h"
#include "ray.h"

typedef struct hit {
    lane_f t;
    lane_u prim; /* EC_NO_ID: none */
    lane_f b1, b2;
} hit;

EC_FN v3 splat_point(global const float *p) { return v3_make(F(p[0]), F(p[1]), F(p[2])); }

/* One triangle against the packet. Closest is by (t, triangle id); skip0 and skip1 are triangles a lane ignores. */
EC_FN void packet_triangle(const ray *r, const hit_filter *filter, global const ec_tri *tri, lane_u skip0, lane_u skip1,
                            hit *h)
{
    v3 v0 = splat_point(tri->v0), v1 = splat_point(tri->v1), v2 = splat_point(tri->v2);
    v3 a = v3_sub(ray_permute(r->z_is_x, r->z_is_y, v0), r->o_permuted);
    v3 b = v3_sub(ray_permute(r->z_is_x, r->z_is_y, v1), r->o_permuted);
    v3 c = v3_sub(ray_permute(r->z_is_x, r->z_is_y, v2), r->o_permuted);
    edges e;
    lane_i m = edges_inside(r->shear_x, r->shear_y, a, b, c, &e);
    if (!any_lane(m)) return;
    uint id = tri->id;
    lane_f t;
    m = m & (skip0 != id) & (skip1 != id) & edges_distance(r, &e, v0, v1, v2, h->t, &t);
    m = m & ((t < h->t) | (U(id) < h->prim));
    if (!any_lane(m)) return;
    lane_f inverse = 1.0f / e.det, b1 = e.v * inverse, b2 = e.w * inverse;
    m = filter_hits(filter, m, U(id), b1, b2, edges_front(r, &e));
    h->t = m ? t : h->t;
    h->prim = m ? U(id) : h->prim;
    h->b1 = m ? b1 : h->b1;
    h->b2 = m ? b2 : h->b2;
}

/* h->t holds t_max on entry (negative: lane off), h->prim EC_NO_ID. any_hit: a lane is done at its first hit, whose t
 * becomes negative. */
EC_FN void traverse_packet(const ray *r, const hit_filter *filter, global const ec_bvh2_node *nodes,
                            global const ec_tri *tris, lane_u skip0, lane_u skip1, bool any_hit, hit *h)
{
    uint stack[EC_BVH_STACK];
    uint depth = 0, current = 0;
    for (;;) {
        if (current & EC_LEAF_BIT) {
            uint first = (current & ~EC_LEAF_BIT) >> 4, end = first + (current & 15u);
            for (uint i = first; i < end; i++) packet_triangle(r, filter, tris + i, skip0, skip1, h);
            if (any_hit) {
                h->t = h->prim != EC_NO_ID ? F(-1.0f) : h->t;
                if (!any_lane(h->t >= 0.0f)) return;
            }
        } else {
            global const ec_bvh2_node *n = nodes + current;
            lane_f far0, far1;
            lane_f near0 = slab_near(r, splat_point(n->lo[0]), splat_point(n->hi[0]), h->t, &far0);
            lane_f near1 = slab_near(r, splat_point(n->lo[1]), splat_point(n->hi[1]), h->t, &far1);
            lane_i m0 = near0 <= far0, m1 = near1 <= far1;
            uint child0 = n->child[0], child1 = n->child[1];
            /* An empty box turned inside out by min and max would look like all of space. */
            bool hit0 = any_lane(m0), hit1 = any_lane(m1) && child1 != EC_NO_CHILD;
            if (hit0 | hit1) {
                if (hit0 & hit1) {
                    bool swap = 2u * count_lanes(m0 & m1 & (near1 < near0)) > count_lanes(m0 & m1);
                    stack[depth++] = swap ? child0 : child1;
                    current = swap ? child1 : child0;
                } else {
                    current = hit0 ? child0 : child1;
                }
                continue;
            }
        }
        if (depth == 0) return;
        current = stack[--depth];
    }
}

#endif
