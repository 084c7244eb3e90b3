/* One ray against the eight boxes of a node: what trees with eight children are traversed by. */
#ifndef EC_LIB_NODE8_H
#define EC_LIB_NODE8_H

#include "block8.h"

/* Gives the numbers of slab_near: the sign of d chooses the plane instead of min and max. */
EC_INLINED float8 node8_near(const ray8 *q, global const float8 *bound, float t_max, uint *mask)
{
    float8 near = max(max(fma(bound[q->near_x], q->r.inverse.x, q->near_offset_x),
                          fma(bound[q->near_y], q->r.inverse.y, q->near_offset_y)),
                      max(fma(bound[q->near_z], q->r.inverse.z, q->near_offset_z), (float8)(0.0f)));
    float8 far = min(min(fma(bound[q->near_x ^ 1], q->r.inverse.x, q->far_offset_x),
                         fma(bound[q->near_y ^ 1], q->r.inverse.y, q->far_offset_y)),
                     min(fma(bound[q->near_z ^ 1], q->r.inverse.z, q->far_offset_z), (float8)(t_max)));
    *mask = mask_bits8(near <= far * EC_SLAB_PAD);
    return near;
}

/* Asks for a node's or a block's cache lines; every second one is enough, processors fetch them in pairs. */
#if defined(__x86_64__) && __has_builtin(__builtin_prefetch)
#define PREFETCH(p) __builtin_prefetch((const void *)(p), 0, 3)
#else
#define PREFETCH(p) (void)(p)
#endif
EC_INLINED void prefetch8(global const ec_bvh8_node *nodes, global const ec_tri8 *blocks, uint child)
{
    bool is_leaf = (child & EC_LEAF_BIT) != 0u;
    ulong at = is_leaf ? (ulong)(blocks + (child & ~EC_LEAF_BIT)) : (ulong)(nodes + child);
    PREFETCH(at);
    PREFETCH(at + 128u);
    PREFETCH(at + 256u);
}

/* Stacks the children that the ray meets before t_max, in the node's order; may write 8, returns how many count. */
EC_INLINED uint node8_push(const ray8 *q, global const ec_bvh8_node *n, float t_max, uint *stack)
{
    uint mask;
#if defined(__AVX512VL__) && __has_builtin(__builtin_ia32_compresssi256_mask)
    int8 child = *(global const int8 *)n->child; /* now, and not only once the mask is known */
    node8_near(q, (global const float8 *)n->bound, t_max, &mask);
    vstore8(as_uint8(__builtin_ia32_compresssi256_mask(child, (int8)(0), (uchar)mask)), 0, stack);
    return popcount(mask);
#else
    uint count = 0;
    node8_near(q, (global const float8 *)n->bound, t_max, &mask);
    for (; mask; mask &= mask - 1) stack[count++] = n->child[lowest_bit(mask)];
    return count;
#endif
}

/* A child to visit: the bits of its distance (no -0), which order as it does, above its index. */
EC_INLINED ulong8 entries8(float8 near, uint8 child) { return convert_ulong8(as_uint8(near + 0.0f)) << 32 | convert_ulong8(child); }

/* A leaf's block, with its references' boxes where the builder has cut triangles. */
EC_INLINED void leaf8(const accel *a, const ray8 *q, const hit_filter *filter, uint child, uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    uint i = child & ~EC_LEAF_BIT;
    global const ec_tri8 *blocks = a->at[1];
    global const ec_box8 *boxes = a->at[2];
    block8_triangles(q, filter, blocks + i, boxes ? boxes + i : 0, skip0, skip1, any_hit, h);
}

#endif
