/* Tests one ray against eight triangles at a time, with SIMD inside the ray. Every accelerator that traces one ray per work-item builds on it.
 * Programs that include this are built with LANES 8, whatever width the paths have. */
#ifndef EC_LIB_BLOCK8_H
#define EC_LIB_BLOCK8_H

#include "../shared/accel.h"
#include "filter.h"
#include "ray.h"
#include "tally.h"

#if LANES != 8
#error "eight triangles at a time are tested by programs built with LANES 8"
#endif

typedef struct ray8 {
    ray r;                                            /* one ray in all lanes */
    uint near_x, near_y, near_z, far_x, far_y, far_z; /* where rows of ec_bvh8_node.bound begin, in bytes */
    uint octant;                                      /* for ec_bvh8_node.order */
    float8 near_offset_x, near_offset_y, near_offset_z, far_offset_x, far_offset_y, far_offset_z;
    uint axis_x, axis_y, axis_z;
} ray8;

typedef struct hit8 {
    float t;
    uint prim;
    float b1, b2;
    TALLIES
} hit8;

/* Sets the row offsets and the octant from the signs of q->r.inverse. */
EC_INLINED void ray8_rows(ray8 *q)
{
    uint x = q->r.inverse.x.s0 < 0.0f, y = q->r.inverse.y.s0 < 0.0f, z = q->r.inverse.z.s0 < 0.0f;
    q->octant = x | y << 1 | z << 2;
    q->near_x = x << 5;
    q->near_y = 64u | y << 5;
    q->near_z = 128u | z << 5;
    q->far_x = q->near_x ^ 32u;
    q->far_y = q->near_y ^ 32u;
    q->far_z = q->near_z ^ 32u;
}

/* Fills in the other fields of *q from q->r. */
EC_INLINED void ray8_signs(ray8 *q)
{
    ray8_rows(q);
    /* Selects, not branches: nobody can predict the signs of a bounced ray. */
    lane_i nx = q->r.inverse.x < 0.0f, ny = q->r.inverse.y < 0.0f, nz = q->r.inverse.z < 0.0f;
    q->near_offset_x = nx ? q->r.hi_offset.x : q->r.lo_offset.x;
    q->near_offset_y = ny ? q->r.hi_offset.y : q->r.lo_offset.y;
    q->near_offset_z = nz ? q->r.hi_offset.z : q->r.lo_offset.z;
    q->far_offset_x = nx ? q->r.lo_offset.x : q->r.hi_offset.x;
    q->far_offset_y = ny ? q->r.lo_offset.y : q->r.hi_offset.y;
    q->far_offset_z = nz ? q->r.lo_offset.z : q->r.hi_offset.z;
    uint z_is_x = q->r.z_is_x.s0 & 1, z_is_y = q->r.z_is_y.s0 & 1;
    q->axis_x = 2 * z_is_x;
    q->axis_y = 1 + z_is_y;
    q->axis_z = 2 - 2 * z_is_x - z_is_y;
}

EC_INLINED ray8 ray8_make(float ox, float oy, float oz, float dx, float dy, float dz, float scene_max)
{
    ray8 q;
    q.r = ray_make(v3_make(F(ox), F(oy), F(oz)), v3_make(F(dx), F(dy), F(dz)), scene_max);
    ray8_signs(&q);
    return q;
}

/* Returns a mask of the triangles that the ray passes inside of and meets before h->t. *close: those that edges_settle must decide. */
EC_INLINED int8 eight_meet(const ray8 *q, edges *e, uint8 id, uint skip0, uint skip1, const hit8 *h, int8 *close, float8 *t,
                           float8 *inverse)
{
    int8 m = edges_inside(e);
    *close = m;
    if (!mask_bits8(m)) return m;
    return edges_distance(&q->r, e, m & (id != skip0) & (id != skip1), (float8)(h->t), close, inverse, t);
}

/* Updates *h with the best of the triangles m, by (t, triangle id), if it is better. lo, hi: the triangles' boxes. any_hit: only records that there
 * is a hit. */
EC_INLINED void eight_take(const ray8 *q, const hit_filter *filter, const edges *e, int8 m, uint8 id, float8 t, float8 inverse,
                           v3 lo, v3 hi, bool any_hit, hit8 *h)
{
    m = m & reference_clamp(&q->r, lo, hi, (float8)(h->t), &t) & ((t < h->t) | (id < h->prim));
    float8 b1 = e->v * inverse + 0.0f, b2 = e->w * inverse + 0.0f; /* no -0: a shared edge is negated */
    m = filter_hits(filter, m, id, b1, b2, edges_front(&q->r, e));
    uint bits = mask_bits8(m), bit = 1;
    if (any_hit) {
        if (bits) h->prim = 0; /* which one does not matter */
        return;
    }
#define EIGHT_ONE(k)                                                                               \
    if ((bits & bit) && (t.s##k < h->t || (t.s##k == h->t && id.s##k < h->prim))) {                \
        h->t = t.s##k;                                                                             \
        h->prim = id.s##k;                                                                         \
        h->b1 = b1.s##k;                                                                           \
        h->b2 = b2.s##k;                                                                           \
    }                                                                                              \
    bit <<= 1;
    EACH_LANE(EIGHT_ONE)
#undef EIGHT_ONE
}

EC_INLINED v3 tri8_vertex(global const ec_tri8 *b, uint k)
{
    global const float8 *v = (global const float8 *)b->v[k];
    return v3_make(v[0], v[1], v[2]);
}
EC_INLINED v3 ray8_shear(const ray8 *q, float8 x, float8 y, float8 z)
{
    return ray_shear(q->r.shear_x, q->r.shear_y, v3_make(x - q->r.o_permuted.x, y - q->r.o_permuted.y, z - q->r.o_permuted.z));
}
EC_INLINED v3 tri8_sheared(const ray8 *q, global const ec_tri8 *b, uint k)
{
    global const float8 *v = (global const float8 *)b->v[k];
    return ray8_shear(q, v[q->axis_x], v[q->axis_y], v[q->axis_z]);
}
/* Reads the corner again (volatile), so that callers that seldom need it keep no registers for it. */
EC_INLINED v3 tri8_sheared_again(const ray8 *q, global const ec_tri8 *b, uint k)
{
    volatile global const float8 *v = (volatile global const float8 *)b->v[k];
    return ray8_shear(q, v[q->axis_x], v[q->axis_y], v[q->axis_z]);
}

/* Returns the boxes of eight references: their own or, if `boxes` is NULL, those of the vertices. */
EC_INLINED void block8_boxes(global const ec_tri8 *b, global const ec_box8 *boxes, v3 *lo, v3 *hi)
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

/* Tests eight triangles given by their corners in the world. flat: those that rounding may have flattened, so that they have no normal. */
EC_INLINED void block8_corners(const ray8 *q, const hit_filter *filter, v3 p0, v3 p1, v3 p2, v3 lo, v3 hi, int8 flat,
                               uint8 id, uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    v3 s0 = ray_vertex(&q->r, p0), s1 = ray_vertex(&q->r, p1), s2 = ray_vertex(&q->r, p2);
    edges e = edges_make(s0, s1, s2);
    int8 close;
    float8 t, inverse;
    int8 m = eight_meet(q, &e, id, skip0, skip1, h, &close, &t, &inverse);
    if (!mask_bits8(m)) return;
    if (mask_bits8(close)) {
        t = edges_settle(&q->r, &e, s0, s1, s2, close, inverse, t);
        m = m & (t > 0.0f);
    }
    m = m & !(flat & place_leaves_flat(p0, p1, p2));
    eight_take(q, filter, &e, m, id, t, inverse, lo, hi, any_hit, h);
}

/* Returns whether any of the triangles moves. */
EC_INLINED bool block8_moves(const hit_filter *filter, uint8 id)
{
    return HAS(MOTION) && filter->g.motion && mask_bits8(motion_moves(filter->g.motion, id));
}

/* Tests a block of which some triangles move. */
EC_INLINED void block8_moving(const ray8 *q, const hit_filter *filter, v3 p0, v3 p1, v3 p2, v3 lo, v3 hi, uint8 id,
                              uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    int8 moves = motion_moves(filter->g.motion, id);
    motion_corners(filter->g.motion, filter->g.time, moves, id, &p0, &p1, &p2);
    block8_corners(q, filter, p0, p1, p2, lo, hi, moves, id, skip0, skip1, any_hit, h);
}

/* Tests a block of up to eight triangles. boxes: NULL if no triangle was split. */
EC_INLINED void block8_triangles(const ray8 *q, const hit_filter *filter, global const ec_tri8 *b, global const ec_box8 *boxes,
                                  uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    uint8 id = *(global const uint8 *)b->id;
    v3 lo, hi;
    if (block8_moves(filter, id)) {
        TALLY_TESTS(h, popcount(mask_bits8(id != EC_NO_ID)));
        block8_boxes(b, boxes, &lo, &hi);
        block8_moving(q, filter, tri8_vertex(b, 0), tri8_vertex(b, 1), tri8_vertex(b, 2), lo, hi, id, skip0, skip1, any_hit, h);
        return;
    }
    edges e = edges_make(tri8_sheared(q, b, 0), tri8_sheared(q, b, 1), tri8_sheared(q, b, 2));
    int8 close;
    float8 t, inverse;
    TALLY_TESTS(h, popcount(mask_bits8(id != EC_NO_ID)));
    int8 m = eight_meet(q, &e, id, skip0, skip1, h, &close, &t, &inverse);
    if (!mask_bits8(m)) return;
    if (mask_bits8(close)) {
        t = edges_settle(&q->r, &e, tri8_sheared_again(q, b, 0), tri8_sheared_again(q, b, 1),
                         tri8_sheared_again(q, b, 2), close, inverse, t);
        m = m & (t > 0.0f);
    }
    block8_boxes(b, boxes, &lo, &hi);
    eight_take(q, filter, &e, m, id, t, inverse, lo, hi, any_hit, h);
}

/* Index of the lowest set bit. */
EC_INLINED uint lowest_bit(uint m) { return 31u - clz(m & -m); }

#endif
