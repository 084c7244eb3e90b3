/* Tests one ray against the boxes of a node's eight children, for trees of such nodes. */
#ifndef EC_LIB_NODE8_H
#define EC_LIB_NODE8_H

#include "block8.h"
#include "packed_lanes.h"

EC_INLINED float8 node8_row(global const ec_bvh8_node *n, uint at) { return *(global const float8 *)((global const char *)n->bound + at); }

/* Returns where the ray enters the children's boxes; *meets: those that it meets before t_max. Gives the numbers of slab_near, but the sign of d
 * selects the planes in place of min and max. */
EC_INLINED float8 node8_near(const ray8 *q, global const ec_bvh8_node *n, float t_max, int8 *meets)
{
    float8 near = max(max(fma(node8_row(n, q->near_x), q->r.inverse.x, q->near_offset_x),
                          fma(node8_row(n, q->near_y), q->r.inverse.y, q->near_offset_y)),
                      max(fma(node8_row(n, q->near_z), q->r.inverse.z, q->near_offset_z), (float8)(0.0f)));
    float8 far = min(min(fma(node8_row(n, q->far_x), q->r.inverse.x, q->far_offset_x),
                         fma(node8_row(n, q->far_y), q->r.inverse.y, q->far_offset_y)),
                     min(fma(node8_row(n, q->far_z), q->r.inverse.z, q->far_offset_z), (float8)(t_max)));
    *meets = near <= far * EC_SLAB_PAD;
    return near;
}

/* Prefetches the cache lines of a node or a block; every second one is enough, since processors fetch them in pairs. */
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

/* Pushes the children that the ray meets before t_max, in the node's order; returns how many. May write 8 whatever it returns. */
EC_INLINED uint node8_push(const ray8 *q, global const ec_bvh8_node *n, float t_max, uint *stack)
{
    int8 meets;
#if PERMUTES_LANES
    int8 child = *(global const int8 *)n->child; /* loaded before the mask is known, not after */
    node8_near(q, n, t_max, &meets);
    uint mask = mask_bits8(meets);
    vstore8(as_uint8(pack8(child, mask)), 0, stack);
    return popcount(mask);
#else
    uint count = 0;
    node8_near(q, n, t_max, &meets);
    for (uint mask = mask_bits8(meets); mask; mask &= mask - 1) stack[count++] = n->child[lowest_bit(mask)];
    return count;
#endif
}

/* Children to visit, and where the ray enters their boxes. */
typedef struct stack8 {
    float near[EC_BVH8_STACK];
    uint child[EC_BVH8_STACK];
} stack8;

/* Pushes the children that the ray meets before t_max, roughly with the nearest on top: in the node's order for the direction's octant, which takes
 * no branch (Fuetterling, Lojewski, Pfreundt, Ebert 2017, "Accelerated single ray tracing for wide vector units"). Returns the new depth; may write 8
 * beyond it. */
EC_INLINED uint node8_push_near(const ray8 *q, global const ec_bvh8_node *n, float t_max, stack8 *stack, uint depth)
{
    int8 meets;
    uint order = n->order[q->octant];
#if PERMUTES_LANES
    int8 slots = lanes8_spread(order);
    float8 near = node8_near(q, n, t_max, &meets);
    uint mask = mask_bits8(permute8(meets, slots));
    int8 lanes = pack8(slots, mask);
    vstore8(as_float8(permute8(as_int8(near), lanes)), 0, stack->near + depth);
    vstore8(as_uint8(permute8(*(global const int8 *)n->child, lanes)), 0, stack->child + depth);
    return depth + popcount(mask);
#else
    float near[8];
    vstore8(node8_near(q, n, t_max, &meets), 0, near);
    uint mask = mask_bits8(meets);
    for (uint k = 0; k < 8; k++, order >>= 3) {
        uint slot = order & 7u;
        stack->near[depth] = near[slot];
        stack->child[depth] = n->child[slot];
        depth += mask >> slot & 1u;
    }
    return depth;
#endif
}

/* Makes stack entries of children: the bits of the distance (no -0), which order as it does, above the child's index. */
EC_INLINED ulong8 entries8(float8 near, uint8 child) { return convert_ulong8(as_uint8(near + 0.0f)) << 32 | convert_ulong8(child); }

/* Tests a leaf's block, with its references' boxes if the builder has split triangles. */
EC_INLINED void leaf8(const accel *a, const ray8 *q, const hit_filter *filter, uint child, uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    uint i = child & ~EC_LEAF_BIT;
    global const ec_tri8 *blocks = a->at[1];
    global const ec_box8 *boxes = a->at[2];
    block8_triangles(q, filter, blocks + i, boxes ? boxes + i : 0, skip0, skip1, any_hit, h);
}

#endif
