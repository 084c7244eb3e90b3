/* Traces one ray through the 8-wide BVH, with SIMD inside the ray: eight boxes or eight triangles at a time. Wins on CPUs in large scenes and on
 * incoherent rays. */
#ifndef EC_LIB_TRAVERSE_BVH8_H
#define EC_LIB_TRAVERSE_BVH8_H

#include "node8.h"

/* Sets *current to the nearest of the children of `mask`, and pushes the others, the nearest on top. Returns false if there are none. */
EC_INLINED bool bvh8_sort(float8 near, uint mask, uint8 child, ulong *stack, uint *depth, uint *current)
{
    ulong entry[8];
    vstore8(entries8(near, child), 0, entry);
    if (!mask) return false;
    ulong nearest = entry[lowest_bit(mask)];
    mask &= mask - 1;
    if (mask) { /* two are sorted without a branch, which nobody could predict; the others by insertion */
        ulong next = entry[lowest_bit(mask)];
        uint base = *depth, top = base;
        stack[top++] = max(nearest, next);
        nearest = min(nearest, next);
        for (mask &= mask - 1; mask; mask &= mask - 1) {
            next = entry[lowest_bit(mask)];
            ulong far = max(nearest, next);
            nearest = min(nearest, next);
            uint k = top++;
            for (; k > base && stack[k - 1] < far; k--) stack[k] = stack[k - 1];
            stack[k] = far;
        }
        *depth = top;
    }
    *current = (uint)nearest;
    return true;
}

/* Visits node *current, and sets *current to the nearest child that the ray meets. Returns false if it meets none. */
EC_INLINED bool bvh8_enter(const accel *a, const ray8 *q, hit8 *h, ulong *stack, uint *depth, uint *current)
{
    global const ec_bvh8_node *n = (global const ec_bvh8_node *)a->at[0] + *current;
    TALLY_NODE(h);
    int8 meets;
    uint8 child = *(global const uint8 *)n->child; /* loaded before the distances are known, not after */
    float8 near = node8_near(q, n, h->t, &meets);
    return bvh8_sort(near, mask_bits8(meets), child, stack, depth, current);
}

/* Pops into *current the next entry that the ray enters before its best hit. Returns false if there is none. */
EC_INLINED bool bvh8_return(const hit8 *h, const ulong *stack, uint *depth, uint *current)
{
    do {
        if (*depth == 0) return false;
        --*depth;
    } while ((uint)(stack[*depth] >> 32) > as_uint(h->t));
    *current = (uint)stack[*depth];
    return true;
}

/* Finds the closest hit in node or leaf `current`. */
EC_INLINED void bvh8_below(const accel *a, const ray8 *q, const hit_filter *filter, uint current, uint skip0, uint skip1, hit8 *h)
{
    ulong stack[EC_BVH8_STACK];
    uint depth = 0;
    for (;;) {
        uint before = depth;
        if (current & EC_LEAF_BIT) {
            leaf8(a, q, filter, current, skip0, skip1, false, h);
        } else if (bvh8_enter(a, q, h, stack, &depth, &current)) {
            if (depth > before) prefetch8(a->at[0], a->at[1], (uint)stack[depth - 1]);
            continue;
        }
        if (!bvh8_return(h, stack, &depth, &current)) return;
    }
}

EC_INLINED void bvh8_closest(const accel *a, const ray8 *q, const hit_filter *filter, uint skip0, uint skip1, hit8 *h)
{
    bvh8_below(a, q, filter, 0, skip0, skip1, h);
}

/* Returns whether anything is in the way before t = h->t. */
EC_INLINED bool bvh8_any(const accel *a, const ray8 *q, const hit_filter *filter, uint skip0, uint skip1, hit8 *h)
{
    global const ec_bvh8_node *nodes = a->at[0];
    global const ec_tri8 *blocks = a->at[1];
    uint stack[EC_BVH8_STACK];
    uint depth = 0, current = 0;
    for (;;) {
        if (current & EC_LEAF_BIT) {
            leaf8(a, q, filter, current, skip0, skip1, true, h);
            if (h->prim != EC_NO_ID) return true;
        } else {
            TALLY_NODE(h);
            depth += node8_push(q, nodes + current, h->t, stack + depth);
        }
        if (depth == 0) return false;
        current = stack[--depth];
        if (depth) prefetch8(nodes, blocks, stack[depth - 1]);
    }
}

#ifdef INTERLEAVE
#include "trace_interleaved.h"
#else
#define ACCEL bvh8
#include "trace_rays.h"
#undef ACCEL
#endif

#endif
