/* Traces one ray through a kd-tree, three levels of planes at a time in the lanes of a vector, near children first; leaves are blocks of eight
 * triangles.
 *
 * A plane is met over a span, from its near to its far time with the widened offsets of slab_near: the side before it is left at
 * the far time, the side behind it entered at the near one. Why no hit is lost: let t be a hit's distance, clamped to the near
 * side of the triangle's box, and s <= t that near side. At every plane s lies in the span of a side that the box overlaps, because
 * planes and box go through the same monotone arithmetic; so a leaf that holds the triangle is entered no later than t. */
#ifndef EC_LIB_TRAVERSE_KDTREE_H
#define EC_LIB_TRAVERSE_KDTREE_H

#include "block8.h"

typedef struct kd_entry {
    uint child;
    float enter, leave;
} kd_entry;

/* Computes when the ray enters and leaves each of the eight children; returns the mask of those that it meets within [enter, leave]. */
EC_FN uint kd_children(const ray8 *q, global const ec_kd_node *n, float enter, float leave, float8 *enters, float8 *leaves)
{
    uint8 axis = ((uint8)(n->axes) >> (uint8)(0u, 2u, 4u, 6u, 8u, 10u, 12u, 14u)) & 3u;
    int8 x = axis == 0u, y = axis == 1u, z = axis == 2u;
    float8 plane = vload8(0, n->plane);
    plane.s7 = 0.0f; /* holds the axes' bits */
    float8 inverse = x ? q->r.inverse.x : (y ? q->r.inverse.y : (z ? q->r.inverse.z : (float8)(0.0f)));
    float8 near_offset = x ? q->near_offset_x : (y ? q->near_offset_y : (z ? q->near_offset_z : (float8)(-INFINITY)));
    float8 far_offset = x ? q->far_offset_x : (y ? q->far_offset_y : (z ? q->far_offset_z : (float8)(INFINITY)));
    float8 begins = fma(plane, inverse, near_offset), ends = fma(plane, inverse, far_offset) * EC_SLAB_PAD;
    /* The side above a plane is behind it for rays that go up: it has a beginning, and the side below an end. */
    int8 down = inverse < 0.0f;
    float8 above_enter = down ? (float8)(-INFINITY) : begins, above_leave = down ? ends : (float8)(INFINITY);
    float8 below_enter = down ? begins : (float8)(-INFINITY), below_leave = down ? (float8)(INFINITY) : ends;
    const int8 first = (int8)(0, 0, 0, 0, -1, -1, -1, -1), second = (int8)(0, 0, -1, -1, 0, 0, -1, -1);
    const int8 third = (int8)(0, -1, 0, -1, 0, -1, 0, -1);
    *enters = max(max((float8)(enter), first ? above_enter.s00000000 : below_enter.s00000000),
                  max(second ? above_enter.s11112222 : below_enter.s11112222,
                      third ? above_enter.s33445566 : below_enter.s33445566));
    *leaves = min(min((float8)(leave), first ? above_leave.s00000000 : below_leave.s00000000),
                  min(second ? above_leave.s11112222 : below_leave.s11112222,
                      third ? above_leave.s33445566 : below_leave.s33445566));
    return mask_bits8((*enters <= *leaves) & (*(global const uint8 *)n->child != EC_NO_CHILD));
}

EC_FN void kdtree_trace(const accel *a, const ray8 *q, const hit_filter *filter, uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    global const ec_kd_header *header = a->at[0];
    global const ec_kd_node *nodes = a->at[1];
    global const ec_tri8 *blocks = a->at[2];
    global const ec_box8 *boxes = a->at[3];
    const v3 lo = v3_make(F(header->lo[0]), F(header->lo[1]), F(header->lo[2]));
    const v3 hi = v3_make(F(header->hi[0]), F(header->hi[1]), F(header->hi[2]));
    float8 all_leave, all_enter = slab_near(&q->r, lo, hi, F(h->t), &all_leave);
    float enter = all_enter.s0, leave = all_leave.s0;
    if (!(enter <= leave)) return;
    kd_entry stack[EC_KD_STACK];
    uint depth = 0, current = 0;
    for (;;) {
        if (current & EC_LEAF_BIT) {
            uint at = (current & ~EC_LEAF_BIT) >> 6, end = at + (current & EC_KD_LEAF_MOST);
            for (uint i = at; i < end; i++)
                block8_triangles(q, filter, blocks + i, boxes ? boxes + i : 0, skip0, skip1, any_hit, h);
            if (any_hit && h->prim != EC_NO_ID) return;
        } else {
            global const ec_kd_node *n = nodes + current;
            float8 enters8, leaves8;
            float enters[8], leaves[8];
            uint child[8];
            TALLY_NODE(h);
            uint mask = kd_children(q, n, enter, leave, &enters8, &leaves8);
            vstore8(*(global const uint8 *)n->child, 0, child);
            vstore8(enters8, 0, enters);
            vstore8(leaves8, 0, leaves);
            if (mask) {
                uint base = depth, i = lowest_bit(mask);
                kd_entry entry = {child[i], enters[i], leaves[i]};
                mask &= mask - 1;
                while (mask) { /* insertion sort on the stack, farthest first; `entry` is the nearest so far */
                    i = lowest_bit(mask);
                    mask &= mask - 1;
                    kd_entry next = {child[i], enters[i], leaves[i]};
                    if (!any_hit && next.enter < entry.enter) {
                        kd_entry swap = entry;
                        entry = next;
                        next = swap;
                    }
                    uint k = depth++;
                    while (!any_hit && k > base && stack[k - 1].enter < next.enter) {
                        stack[k] = stack[k - 1];
                        k--;
                    }
                    stack[k] = next;
                }
                current = entry.child;
                enter = entry.enter;
                leave = entry.leave;
                continue;
            }
        }
        do {
            if (depth == 0) return;
            depth--;
        } while (stack[depth].enter > h->t);
        current = stack[depth].child;
        enter = stack[depth].enter;
        leave = min(stack[depth].leave, h->t);
    }
}

#define ACCEL kdtree
#define ACCEL_HAS_TRACE
#include "trace_rays.h"
#undef ACCEL_HAS_TRACE
#undef ACCEL

#endif
