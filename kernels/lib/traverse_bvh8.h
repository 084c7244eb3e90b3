/* One ray through the 8-wide BVH, SIMD inside the ray: eight boxes or eight triangles at a time. Programs that include this
 * are built with LANES 8, whatever width the paths have. Wins on CPUs in large scenes and on incoherent rays. */
#ifndef EC_LIB_TRAVERSE_BVH8_H
#define EC_LIB_TRAVERSE_BVH8_H

#include "../shared/accel.h"
#include "filter.h"
#include "ray.h"

#if LANES != 8
#error "the 8-wide BVH is traversed by programs built with LANES 8"
#endif

typedef struct ray8 {
    ray r;                      /* splat */
    uint near_x, near_y, near_z; /* rows of ec_bvh8_node.bound */
    float8 near_offset_x, near_offset_y, near_offset_z, far_offset_x, far_offset_y, far_offset_z;
    uint axis_x, axis_y, axis_z;
} ray8;

typedef struct hit8 {
    float t;
    uint prim;
    float b1, b2;
} hit8;

EC_FN ray8 ray8_make(float ox, float oy, float oz, float dx, float dy, float dz, float scene_max)
{
    ray8 q;
    q.r = ray_make(v3_make(F(ox), F(oy), F(oz)), v3_make(F(dx), F(dy), F(dz)), scene_max);
    /* Selects, not branches: nobody can predict the signs of a bounced ray. */
    lane_i nx = q.r.inverse.x < 0.0f, ny = q.r.inverse.y < 0.0f, nz = q.r.inverse.z < 0.0f;
    q.near_x = 0 | (nx.s0 & 1);
    q.near_y = 2 | (ny.s0 & 1);
    q.near_z = 4 | (nz.s0 & 1);
    q.near_offset_x = nx ? q.r.hi_offset.x : q.r.lo_offset.x;
    q.near_offset_y = ny ? q.r.hi_offset.y : q.r.lo_offset.y;
    q.near_offset_z = nz ? q.r.hi_offset.z : q.r.lo_offset.z;
    q.far_offset_x = nx ? q.r.lo_offset.x : q.r.hi_offset.x;
    q.far_offset_y = ny ? q.r.lo_offset.y : q.r.hi_offset.y;
    q.far_offset_z = nz ? q.r.lo_offset.z : q.r.hi_offset.z;
    uint z_is_x = q.r.z_is_x.s0 & 1, z_is_y = q.r.z_is_y.s0 & 1;
    q.axis_x = 2 * z_is_x;
    q.axis_y = 1 + z_is_y;
    q.axis_z = 2 - 2 * z_is_x - z_is_y;
    return q;
}

/* The same numbers as slab_near: the sign of d chooses the plane instead of min and max. */
EC_FN float8 node8_near(const ray8 *q, global const float8 *bound, float t_max, uint *mask)
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

EC_FN v3 tri8_vertex(global const ec_tri8 *b, uint k)
{
    global const float8 *v = (global const float8 *)b->v[k];
    return v3_make(v[0], v[1], v[2]);
}
/* Boxes of eight references: their own, or without those (`boxes` NULL) what the vertices span. */
EC_FN void block8_boxes(global const ec_tri8 *b, global const ec_box8 *boxes, v3 *lo, v3 *hi)
{
    if (boxes) {
        global const float8 *x = (global const float8 *)boxes;
        *lo = v3_make(x[0], x[1], x[2]);
        *hi = v3_make(x[3], x[4], x[5]);
        return;
    }
    v3 v0 = tri8_vertex(b, 0), v1 = tri8_vertex(b, 1), v2 = tri8_vertex(b, 2);
    *lo = v3_make(min(v0.x, min(v1.x, v2.x)), min(v0.y, min(v1.y, v2.y)), min(v0.z, min(v1.z, v2.z)));
    *hi = v3_make(max(v0.x, max(v1.x, v2.x)), max(v0.y, max(v1.y, v2.y)), max(v0.z, max(v1.z, v2.z)));
}

EC_FN v3 tri8_sheared(const ray8 *q, global const ec_tri8 *b, uint k)
{
    global const float8 *v = (global const float8 *)b->v[k];
    v3 p = v3_make(v[q->axis_x] - q->r.o_permuted.x, v[q->axis_y] - q->r.o_permuted.y, v[q->axis_z] - q->r.o_permuted.z);
    return ray_shear(q->r.shear_x, q->r.shear_y, p);
}

/* Eight triangles against the ray. any_hit: only whether there is one. */
EC_FN void block8_triangles(const ray8 *q, const hit_filter *filter, global const ec_tri8 *b,
                             global const ec_box8 *boxes, uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    edges e = edges_make(tri8_sheared(q, b, 0), tri8_sheared(q, b, 1), tri8_sheared(q, b, 2));
    int8 m = edges_inside(&e);
    if (!mask_bits8(m)) return;
    uint8 id = *(global const uint8 *)b->id;
    float8 t, inverse;
    m = m & (id != skip0) & (id != skip1) & edges_distance(&q->r, &e, (float8)(h->t), &inverse, &t);
    if (!mask_bits8(m)) return;
    v3 lo, hi;
    block8_boxes(b, boxes, &lo, &hi);
    m = m & reference_clamp(&q->r, lo, hi, (float8)(h->t), &t) & ((t < h->t) | (id < h->prim));
    float8 b1 = e.v * inverse + 0.0f, b2 = e.w * inverse + 0.0f; /* no -0: a shared edge is negated */
    m = filter_hits(filter, m, id, b1, b2, edges_front(&q->r, &e));
    uint bits = mask_bits8(m), bit = 1;
    if (any_hit) {
        if (bits) h->prim = 0; /* which one does not matter */
        return;
    }
#define BLOCK8_ONE(k)                                                                              \
    if ((bits & bit) && (t.s##k < h->t || (t.s##k == h->t && id.s##k < h->prim))) {                \
        h->t = t.s##k;                                                                             \
        h->prim = id.s##k;                                                                         \
        h->b1 = b1.s##k;                                                                           \
        h->b2 = b2.s##k;                                                                           \
    }                                                                                              \
    bit <<= 1;
    EACH_LANE(BLOCK8_ONE)
#undef BLOCK8_ONE
}

/* Index of the lowest set bit. */
EC_FN uint lowest_bit(uint m) { return 31u - clz(m & -m); }

/* Asks for a node's or a block's cache lines; every second one is enough, processors fetch them in pairs. */
#if defined(__x86_64__) && __has_builtin(__builtin_prefetch)
#define PREFETCH(p) __builtin_prefetch((const void *)(p), 0, 3)
#else
#define PREFETCH(p) (void)(p)
#endif
EC_FN void prefetch8(global const ec_bvh8_node *nodes, global const ec_tri8 *blocks, uint child)
{
    bool is_leaf = (child & EC_LEAF_BIT) != 0u;
    ulong at = is_leaf ? (ulong)(blocks + (child & ~EC_LEAF_BIT)) : (ulong)(nodes + child);
    PREFETCH(at);
    PREFETCH(at + 128u);
    PREFETCH(at + 256u);
}

/* The lanes of m close together, in the low ones. */
EC_FN uint8 pack8(uint8 v, uint mask)
{
#if defined(__AVX512VL__) && __has_builtin(__builtin_ia32_compresssi256_mask)
    return as_uint8(__builtin_ia32_compresssi256_mask(as_int8(v), (int8)(0), (uchar)mask));
#else
    uint from[8], to[8] = {0}, count = 0;
    vstore8(v, 0, from);
    for (; mask; mask &= mask - 1) to[count++] = from[lowest_bit(mask)];
    return vload8(0, to);
#endif
}

/* A leaf's block, with its boxes where there are any. */
EC_FN void leaf8(const ray8 *q, const hit_filter *filter, global const ec_tri8 *blocks, global const ec_box8 *boxes,
                 uint child, uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    uint i = child & ~EC_LEAF_BIT;
    block8_triangles(q, filter, blocks + i, boxes ? boxes + i : 0, skip0, skip1, any_hit, h);
}

typedef struct stack8 {
    uint node;
    float near;
} stack8;

EC_FN void traverse8_closest(const ray8 *q, const hit_filter *filter, global const ec_bvh8_node *nodes,
                              global const ec_tri8 *blocks, global const ec_box8 *boxes, uint skip0, uint skip1, hit8 *h)
{
    stack8 stack[EC_BVH8_STACK];
    uint depth = 0, current = 0;
    for (;;) {
        if (current & EC_LEAF_BIT) {
            leaf8(q, filter, blocks, boxes, current, skip0, skip1, false, h);
        } else {
            global const ec_bvh8_node *n = nodes + current;
            uint mask;
            float near[8];
            uint child[8];
            vstore8(*(global const uint8 *)n->child, 0, child); /* now, and not only once `near` is known */
            vstore8(node8_near(q, (global const float8 *)n->bound, h->t, &mask), 0, near);
            if (mask) {
                uint base = depth, i = lowest_bit(mask);
                stack8 entry = {child[i], near[i]};
                mask &= mask - 1;
                while (mask) { /* insertion sort on the stack, farthest first; `entry` is the nearest so far */
                    i = lowest_bit(mask);
                    mask &= mask - 1;
                    stack8 next = {child[i], near[i]};
                    if (next.near < entry.near) {
                        stack8 swap = entry;
                        entry = next;
                        next = swap;
                    }
                    uint k = depth++;
                    while (k > base && stack[k - 1].near < next.near) {
                        stack[k] = stack[k - 1];
                        k--;
                    }
                    stack[k] = next;
                }
                current = entry.node;
                if (depth > base) prefetch8(nodes, blocks, stack[depth - 1].node);
                continue;
            }
        }
        do {
            if (depth == 0) return;
            depth--;
        } while (stack[depth].near > h->t);
        current = stack[depth].node;
    }
}

/* Is anything in the way before t = h->t? */
EC_FN bool traverse8_any(const ray8 *q, const hit_filter *filter, global const ec_bvh8_node *nodes,
                          global const ec_tri8 *blocks, global const ec_box8 *boxes, uint skip0, uint skip1, hit8 *h)
{
    uint stack[EC_BVH8_STACK];
    uint depth = 0, current = 0;
    for (;;) {
        if (current & EC_LEAF_BIT) {
            leaf8(q, filter, blocks, boxes, current, skip0, skip1, true, h);
            if (h->prim != EC_NO_ID) return true;
        } else {
            global const ec_bvh8_node *n = nodes + current;
            uint mask;
            uint8 child = *(global const uint8 *)n->child;
            node8_near(q, (global const float8 *)n->bound, h->t, &mask);
            vstore8(pack8(child, mask), 0, stack + depth);
            depth += popcount(mask);
        }
        if (depth == 0) return false;
        current = stack[--depth];
        if (depth) prefetch8(nodes, blocks, stack[depth - 1]);
    }
}

#endif
