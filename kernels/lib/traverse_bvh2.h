/* Traces LANES rays through the binary BVH together. Wins on small scenes and coherent rays; with LANES 1 it is the ordinary GPU kernel. */
#ifndef EC_LIB_TRAVERSE_BVH2_H
#define EC_LIB_TRAVERSE_BVH2_H

#include "../shared/accel.h"
#include "filter.h"
#include "ray.h"
#include "stack_bvh2.h"
#include "tally.h"

typedef struct hit {
    lane_f t;
    lane_u prim; /* EC_NO_ID: none */
    lane_f b1, b2;
    TALLIES
} hit;

EC_FN v3 splat_point(global const float *p) { return v3_make(F(p[0]), F(p[1]), F(p[2])); }

/* Returns the low corner of a reference's box: its own or, if `box` is NULL, that of the vertices. box_high: the high one. */
EC_FN v3 box_low(global const ec_tri *t, global const ec_box *box)
{
    if (box) return splat_point(box->lo);
    return v3_make(F(min(t->v0[0], min(t->v1[0], t->v2[0]))), F(min(t->v0[1], min(t->v1[1], t->v2[1]))),
                   F(min(t->v0[2], min(t->v1[2], t->v2[2]))));
}
EC_FN v3 box_high(global const ec_tri *t, global const ec_box *box)
{
    if (box) return splat_point(box->hi);
    return v3_make(F(max(t->v0[0], max(t->v1[0], t->v2[0]))), F(max(t->v0[1], max(t->v1[1], t->v2[1]))),
                   F(max(t->v0[2], max(t->v1[2], t->v2[2]))));
}

/* Takes triangle id, whose box is lo to hi and which lanes m meet at t, where it is the closest so far, by (t, triangle id). */
EC_FN void packet_keep(const ray *r, const hit_filter *filter, v3 lo, v3 hi, lane_u id, const edges *e, lane_i m,
                       lane_f t, lane_f inverse, hit *h)
{
    m = m & reference_clamp(r, lo, hi, h->t, &t) & ((t < h->t) | (id < h->prim));
    lane_f b1 = e->v * inverse + 0.0f, b2 = e->w * inverse + 0.0f; /* no -0: a shared edge is negated */
    m = filter_hits(filter, m, id, b1, b2, edges_front(r, e));
    h->t = m ? t : h->t;
    h->prim = m ? id : h->prim;
    h->b1 = m ? b1 : h->b1;
    h->b2 = m ? b2 : h->b2;
}

/* Takes the triangle inside whose edges e lanes m pass: tri or, where `second`, the other half of its quad, which is `other` triangles on (0 where
 * there is none). skip0 and skip1 are triangles a lane ignores. */
EC_FN void packet_take(const ray *r, const hit_filter *filter, global const ec_tri *tri, global const ec_box *box,
                       uint other, lane_i second, const edges *e, lane_i m, lane_u skip0, lane_u skip1, hit *h)
{
    lane_u id = second ? U(tri[other].id) : U(tri[0].id);
    lane_i close;
    lane_f t, inverse;
    m = edges_distance(r, e, m & (skip0 != id) & (skip1 != id), h->t, &close, &inverse, &t);
    if (!any_lane(m)) return;
    if (any_lane(close)) {
        v3 b = v3_select(second, splat_point(tri[other].v1), splat_point(tri->v1));
        v3 c = v3_select(second, splat_point(tri[other].v2), splat_point(tri->v2));
        t = edges_settle(r, e, ray_vertex(r, splat_point(tri->v0)), ray_vertex(r, b), ray_vertex(r, c), close, inverse, t);
        m = m & (t > 0.0f);
    }
    global const ec_box *next = box ? box + other : 0;
    v3 lo = v3_select(second, box_low(tri + other, next), box_low(tri, box));
    v3 hi = v3_select(second, box_high(tri + other, next), box_high(tri, box));
    packet_keep(r, filter, lo, hi, id, e, m, t, inverse, h);
}

EC_FN edges edges_select(lane_i m, edges a, edges b)
{
    edges e = {m ? a.u : b.u, m ? a.v : b.v, m ? a.w : b.w, m ? a.det : b.det,
               m ? a.z0 : b.z0, m ? a.z1 : b.z1, m ? a.z2 : b.z2};
    return e;
}

/* Tests a moving triangle, for each lane where it is at the lane's time. Moving triangles have boxes, and no second half. */
EC_FN void packet_moving(const ray *r, const hit_filter *filter, global const ec_tri *tri, global const ec_box *box,
                         lane_u skip0, lane_u skip1, hit *h)
{
    v3 p0 = v3_zero(), p1 = p0, p2 = p0;
    lane_u id = U(tri->id);
    motion_corners(filter->g.motion, filter->g.time, TRUE_MASK, id, &p0, &p1, &p2);
    v3 a = ray_vertex(r, p0), b = ray_vertex(r, p1), c = ray_vertex(r, p2);
    edges e = edges_make(a, b, c);
    lane_i m = edges_inside(&e), close;
    lane_f t, inverse;
    if (!any_lane(m)) return;
    m = edges_distance(r, &e, m & (skip0 != id) & (skip1 != id), h->t, &close, &inverse, &t);
    if (!any_lane(m)) return;
    if (any_lane(close)) {
        t = edges_settle(r, &e, a, b, c, close, inverse, t);
        m = m & (t > 0.0f);
    }
    m = m & !place_leaves_flat(p0, p1, p2);
    packet_keep(r, filter, splat_point(box->lo), splat_point(box->hi), id, &e, m, t, inverse, h);
}

/* Tests one triangle, or two that form a quad, against the packet. Returns how many. */
EC_FN uint packet_triangles(const ray *r, const hit_filter *filter, global const ec_tri *tri, global const ec_box *box,
                            lane_u skip0, lane_u skip1, hit *h)
{
    if (HAS(MOTION) && filter->g.motion && tri->id < ((global const uint *)filter->g.motion)[EC_MOTION_TRIANGLES]) {
        packet_moving(r, filter, tri, box, skip0, skip1, h);
        return 1;
    }
    v3 a = ray_vertex(r, splat_point(tri->v0)), b = ray_vertex(r, splat_point(tri->v1)), c = ray_vertex(r, splat_point(tri->v2));
    edges e = edges_make(a, b, c);
    lane_i m = edges_inside(&e), n = !TRUE_MASK;
    uint has_pair = LANES == 1 ? 0u : tri->has_pair; /* a single ray meets the halves one after the other, at the same t, which saves registers */
    edges f = e;
    if (has_pair) {
        v3 d = ray_vertex(r, splat_point(tri[1].v2));
        f.u = ray_edge(d, c), f.v = ray_edge(a, d), f.w = -e.v, f.z1 = c.z, f.z2 = d.z;
        n = edges_inside(&f);
    }
    /* A lane is inside one of the two; inside both only on the diagonal, or where the quad is folded: then it takes the first one first. */
    for (bool again = any_lane(m | n); again;) {
        again = any_lane(m & n);
        lane_i second = again ? !TRUE_MASK : n;
        edges met = edges_select(second, f, e);
        packet_take(r, filter, tri, box, has_pair, second, &met, again ? m : m | n, skip0, skip1, h);
        m = m & !n;
    }
    return 1 + has_pair;
}

/* h->t holds t_max on entry (negative: lane off), h->prim EC_NO_ID. any_hit: a lane is done at its first hit, whose t
 * becomes negative. */
EC_FN void bvh2_trace(const accel *a, const ray *r, const hit_filter *filter, lane_u skip0, lane_u skip1, bool any_hit, hit *h)
{
    global const ec_bvh2_node *nodes = a->at[0];
    global const ec_tri *tris = a->at[1];
    global const ec_box *boxes = a->at[2];
    uint entries[STACK_ENTRIES];
    bvh2_stack stack;
    uint current = 0;
    stack_start(&stack, entries);
    for (;;) {
        if (current & EC_LEAF_BIT) {
            uint first = (current & ~EC_LEAF_BIT) >> 4, end = first + (current & 15u);
            TALLY_TESTS(h, end - first);
            for (uint i = first; i < end;)
                i += packet_triangles(r, filter, tris + i, boxes ? boxes + i : 0, skip0, skip1, h);
            if (any_hit) {
                h->t = h->prim != EC_NO_ID ? F(-1.0f) : h->t;
                if (!any_lane(h->t >= 0.0f)) return;
            }
        } else {
            global const ec_bvh2_node *n = nodes + current;
            TALLY_NODE(h);
            lane_f far0, far1;
            lane_f near0 = slab_near(r, splat_point(n->lo[0]), splat_point(n->hi[0]), h->t, &far0);
            lane_f near1 = slab_near(r, splat_point(n->lo[1]), splat_point(n->hi[1]), h->t, &far1);
            lane_i m0 = near0 <= far0, m1 = near1 <= far1;
            uint child0 = n->child[0], child1 = n->child[1];
            /* An empty box turned inside out by min and max would look like all of space. */
            bool hit0 = any_lane(m0), hit1 = any_lane(m1) && child1 != EC_NO_CHILD;
            if (hit0 & hit1) {
                bool swap = !any_hit && 2u * count_lanes(m0 & m1 & (near1 < near0)) > count_lanes(m0 & m1);
                current = stack_both(&stack, swap ? child1 : child0, swap ? child0 : child1);
                continue;
            }
            if (hit0 | hit1) {
                stack_one(&stack);
                current = hit0 ? child0 : child1;
                continue;
            }
        }
        if (!stack_next(&stack, &current)) return;
    }
}

#define ACCEL bvh2
#include "trace_packets.h"
#undef ACCEL

#endif
