/* Traces eight rays that go much the same way, as those of a pixel do, through the 8-wide BVH together: a node's boxes are tested once for all of
 * them, by the least and the greatest of their origins and inverse directions. At a leaf each ray is tested against the box, and then against the
 * triangles by itself, so the hits are those of bvh8_closest.
 *
 * Why no ray loses a box: along an axis that all rays go up, ray k enters it at v_k = (p - o_k - b) i_k, where b is ray_make's bound. With O the greatest
 * o_k + b and i the least inverse, (p - O) i <= v_k where p >= O; elsewhere it is negative, as if the ray began inside. Exits are alike, by the least origin
 * and the greatest inverse. Rounding is under 3 u S i_k in v_k and as much in the other, S being |o| + scene_max, and b is taken 8 u S larger. */
#ifndef EC_LIB_PACKET8_H
#define EC_LIB_PACKET8_H

#include "traverse_bvh8.h"

/* Along one axis, when the first of the rays may enter a box and the last may leave it; the same in all lanes. */
typedef struct slabs8 {
    uint near, far; /* rows of ec_bvh8_node.bound */
    float8 first_inverse, first_offset, last_inverse, last_offset;
} slabs8;

typedef struct packet8 {
    ray r; /* one ray per lane */
    slabs8 x, y, z;
} packet8;

typedef struct hits8 {
    float8 t;
    uint8 prim; /* EC_NO_ID: none */
    float8 b1, b2;
    TALLIES
} hits8;

EC_INLINED float least8(float8 v)
{
    float4 a = min(v.lo, v.hi);
    float2 b = min(a.lo, a.hi);
    return min(b.x, b.y);
}
EC_INLINED float most8(float8 v) { return -least8(-v); }

/* Makes the slabs of one axis; returns false if some rays go up the axis and others down. */
EC_INLINED bool slabs8_make(slabs8 *s, uint axis, float8 o, float8 bound, float8 inverse)
{
    uint downs = mask_bits8(inverse < 0.0f), is_down = downs & 1u;
    float low = least8(o - bound), high = most8(o + bound), least = least8(inverse), most = most8(inverse);
    float first = is_down ? most : least, last = is_down ? least : most;
    s->near = 2u * axis + is_down;
    s->far = s->near ^ 1u;
    s->first_inverse = (float8)(first);
    s->first_offset = (float8)(-((is_down ? low : high) * first));
    s->last_inverse = (float8)(last);
    s->last_offset = (float8)(-((is_down ? high : low) * last));
    return downs == 0u || downs == 255u;
}

/* Completes *p from p->r, of which all lanes count. Returns false if the rays differ in the sign of a direction's component. */
EC_INLINED bool packet8_make(packet8 *p, float scene_max)
{
    const ray *r = &p->r;
    float8 bound = (v3_max_component(v3_abs(r->o)) + scene_max) * (24.0f * EC_ULP);
    bool x = slabs8_make(&p->x, 0, r->o.x, bound, r->inverse.x);
    bool y = slabs8_make(&p->y, 1, r->o.y, bound, r->inverse.y);
    bool z = slabs8_make(&p->z, 2, r->o.z, bound, r->inverse.z);
    return x & y & z;
}

/* Returns when the first of the rays may enter each child of a node; *mask: children that one may meet before t_max. */
EC_INLINED float8 packet8_near(const packet8 *p, global const float8 *bound, float t_max, uint *mask)
{
    float8 near = max(max(fma(bound[p->x.near], p->x.first_inverse, p->x.first_offset), fma(bound[p->y.near], p->y.first_inverse, p->y.first_offset)),
                      max(fma(bound[p->z.near], p->z.first_inverse, p->z.first_offset), (float8)(0.0f)));
    float8 far = min(min(fma(bound[p->x.far], p->x.last_inverse, p->x.last_offset), fma(bound[p->y.far], p->y.last_inverse, p->y.last_offset)),
                     min(fma(bound[p->z.far], p->z.last_inverse, p->z.last_offset), (float8)(t_max)));
    *mask = mask_bits8(near <= far * EC_SLAB_PAD);
    return near;
}

/* Returns a mask of the rays that meet child k before t. */
EC_INLINED uint packet8_meet(const packet8 *p, global const ec_bvh8_node *n, uint k, float8 t)
{
    v3 lo = v3_make(F(n->bound[0][k]), F(n->bound[2][k]), F(n->bound[4][k]));
    v3 hi = v3_make(F(n->bound[1][k]), F(n->bound[3][k]), F(n->bound[5][k]));
    float8 far, near = slab_near(&p->r, lo, hi, t, &far);
    return mask_bits8(near <= far);
}

/* Visits a node as bvh8_enter does, but the stack and *place hold eight times the node's index plus the number of its child. */
EC_INLINED bool packet8_enter(const accel *a, const packet8 *p, uint node, float t_max, ulong *stack, uint *depth, uint *place)
{
    global const ec_bvh8_node *n = (global const ec_bvh8_node *)a->at[0] + node;
    uint mask;
    float8 near = packet8_near(p, (global const float8 *)n->bound, t_max, &mask);
    for (uint left = mask; left; left &= left - 1) prefetch8(a->at[0], a->at[1], n->child[lowest_bit(left)]); /* most of them will be visited */
    return bvh8_sort(near, mask, node << 3 | (uint8)(0, 1, 2, 3, 4, 5, 6, 7), stack, depth, place);
}

EC_INLINED ray8 packet8_ray(const packet8 *p, uint k)
{
    const ray *r = &p->r;
    ray8 q;
#define LANE_OF(field) (float8)(((const float *)&r->field)[k])
    q.r.inverse = v3_make(LANE_OF(inverse.x), LANE_OF(inverse.y), LANE_OF(inverse.z));
    q.r.lo_offset = v3_make(LANE_OF(lo_offset.x), LANE_OF(lo_offset.y), LANE_OF(lo_offset.z));
    q.r.hi_offset = v3_make(LANE_OF(hi_offset.x), LANE_OF(hi_offset.y), LANE_OF(hi_offset.z));
    q.r.o_permuted = v3_make(LANE_OF(o_permuted.x), LANE_OF(o_permuted.y), LANE_OF(o_permuted.z));
    q.r.shear_x = LANE_OF(shear_x);
    q.r.shear_y = LANE_OF(shear_y);
    q.r.scale_z = LANE_OF(scale_z);
#undef LANE_OF
    q.r.z_is_x = (int8)(((const int *)&r->z_is_x)[k]);
    q.r.z_is_y = (int8)(((const int *)&r->z_is_y)[k]);
    ray8_signs(&q);
    return q;
}

/* Traces the rays of the mask `rays` through what is below `child`, one by one. */
EC_CALLED void packet8_each(const accel *a, const packet8 *p, const hit_filter *filter, uint child, uint rays, uint8 skip, hits8 *h)
{
    float *t = (float *)&h->t, *b1 = (float *)&h->b1, *b2 = (float *)&h->b2;
    uint *prim = (uint *)&h->prim;
    for (; rays; rays &= rays - 1) {
        uint k = lowest_bit(rays);
        ray8 q = packet8_ray(p, k);
        hit_filter its = *filter;
        if (HAS(ALPHA)) its.key = (uint8)(((const uint *)&filter->key)[k]);
        hit8 one = {t[k], prim[k], b1[k], b2[k]};
        bvh8_below(a, &q, &its, child, ((const uint *)&skip)[k], EC_NO_ID, &one);
        t[k] = one.t;
        prim[k] = one.prim;
        b1[k] = one.b1;
        b2[k] = one.b2;
#ifdef PROBE
        h->nodes += one.nodes;
        h->tests += one.tests;
#endif
    }
}

/* Traces the rays together until they part: once a ray has come to a leaf alone, every child that only one ray meets is left to that ray. h->t: as in
 * hit8, negative in lanes that are off. */
EC_INLINED void packet8_closest(const accel *a, const packet8 *p, const hit_filter *filter, uint8 skip, hits8 *h)
{
    global const ec_bvh8_node *nodes = a->at[0];
    ulong stack[EC_BVH8_STACK];
    uint depth = 0, place, child = 0;
    bool part = false;
    hit8 last = {most8(h->t), EC_NO_ID, 0.0f, 0.0f}; /* t: the farthest of the rays' closest hits */
    for (;;) {
        TALLY_NODE(h);
        bool goes_on = packet8_enter(a, p, child, last.t, stack, &depth, &place);
        for (;; goes_on = false) {
            if (!goes_on && !bvh8_return(&last, stack, &depth, &place)) return;
            global const ec_bvh8_node *n = nodes + (place >> 3);
            child = n->child[place & 7u];
            bool is_leaf = (child & EC_LEAF_BIT) != 0u;
            if (!is_leaf && !part) break;
            uint rays = packet8_meet(p, n, place & 7u, h->t);
            bool is_one = !(rays & (rays - 1));
            part |= is_one;
            if (!is_leaf && !is_one) break;
            packet8_each(a, p, filter, child, rays, skip, h);
            last.t = most8(h->t);
        }
    }
}

#endif
