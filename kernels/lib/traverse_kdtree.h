/* One ray through a kd-tree, near children first, far ones on a stack; leaves are blocks of eight triangles.
 *
 * A plane is met over a span, from its near to its far time with the widened offsets of slab_near: the side before it is left at
 * the far time, the side behind it entered at the near one. Why no hit is lost: let t be a hit's distance, clamped to the near
 * side of the triangle's box, and s <= t that near side. At every plane s lies in the span of a side that the box overlaps, because
 * planes and box go through the same monotone arithmetic; so a leaf that holds the triangle is entered no later than t. */
#ifndef EC_LIB_TRAVERSE_KDTREE_H
#define EC_LIB_TRAVERSE_KDTREE_H

#include "block8.h"

typedef struct kd_entry {
    uint node;
    float enter, leave;
} kd_entry;

EC_FN void kdtree_trace(const accel *a, const ray8 *q, const hit_filter *filter, uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    global const ec_kd_header *header = a->at[0];
    global const ec_kd_node *nodes = a->at[1];
    global const ec_tri8 *blocks = a->at[2];
    const float inverse[3] = {q->r.inverse.x.s0, q->r.inverse.y.s0, q->r.inverse.z.s0};
    const float near_offset[3] = {q->near_offset_x.s0, q->near_offset_y.s0, q->near_offset_z.s0};
    const float far_offset[3] = {q->far_offset_x.s0, q->far_offset_y.s0, q->far_offset_z.s0};
    float enter = 0.0f, leave = h->t;
    for (uint axis = 0; axis < 3; axis++) {
        bool down = inverse[axis] < 0.0f;
        float lo = header->lo[axis], hi = header->hi[axis];
        enter = max(enter, fma(down ? hi : lo, inverse[axis], near_offset[axis]));
        leave = min(leave, fma(down ? lo : hi, inverse[axis], far_offset[axis]) * EC_SLAB_PAD);
    }
    if (!(enter <= leave)) return;
    kd_entry stack[EC_KD_STACK];
    uint depth = 0, current = 0;
    for (;;) {
        ec_kd_node node = nodes[current];
        uint axis = node.word & 3u, index = node.word >> 2;
        TALLY_NODE(h);
        if (axis < 3u) {
            float begins = fma(node.at.plane, inverse[axis], near_offset[axis]);
            float ends = fma(node.at.plane, inverse[axis], far_offset[axis]) * EC_SLAB_PAD;
            uint behind = inverse[axis] < 0.0f ? 0u : 1u;
            bool before = enter <= ends, after = begins <= leave;
            if (before & after) {
                kd_entry entry = {index + behind, max(enter, begins), leave};
                stack[depth++] = entry;
                leave = min(leave, ends);
            }
            current = index + (before ? 1u - behind : behind);
            continue;
        }
        for (uint i = node.at.first, end = i + index; i < end; i++) {
            block8_triangles(q, filter, blocks + i, skip0, skip1, any_hit, h);
            if (any_hit && h->prim != EC_NO_ID) return;
        }
        do {
            if (depth == 0) return;
            depth--;
        } while (stack[depth].enter > h->t);
        current = stack[depth].node;
        enter = stack[depth].enter;
        leave = min(stack[depth].leave, h->t);
    }
}

EC_FN void kdtree_closest(const accel *a, const ray8 *q, const hit_filter *filter, uint skip0, uint skip1, hit8 *h)
{
    kdtree_trace(a, q, filter, skip0, skip1, false, h);
}

EC_FN bool kdtree_any(const accel *a, const ray8 *q, const hit_filter *filter, uint skip0, uint skip1, hit8 *h)
{
    kdtree_trace(a, q, filter, skip0, skip1, true, h);
    return h->prim != EC_NO_ID;
}

#define ACCEL kdtree
#include "trace_rays.h"
#undef ACCEL

#endif
