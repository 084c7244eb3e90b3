/* Traces one ray through two levels of 8-wide BVHs: the triangles of no instance, then a tree of instances, each of which is entered by
 * transforming the ray into its mesh's own space and left when its tree is done. Only boxes are tested there: a leaf's corners are transformed to
 * the world (instance.h), where triangles are tested as all others are.
 *
 * Why no hit can be lost that accelerators over written-out triangles find. Let u = 2^-24, A = |o| + reach, reach bounding every
 * sum in placing a corner, per axis; R a row of |M^-1|.
 * - What ray.h accepts, the exact ray passes within 16 u A of the triangle's corners in the world (Woop et al. 2013). These are within
 *   4 u reach of M v + t: three fma. So the ray passes within 20 u R A of the triangle in the mesh's space, along each axis.
 * - Entries of the inverse are rounded: u R (|o| + |t|) in the origin and, t d being a distance within the scene, u R A in t d; subtracting
 *   t and three fma: 5 u R A and 4 u R A. The slab's offset takes three roundings more. In all under 35 u R A; 40 are taken (host).
 * - A hit is taken at t_R = max(t, near_R), both at least where the ray meets the near side of the triangle's box along d's largest
 *   component. Boxes here have other axes, so that the ray may enter them later than that, but no later than where it leaves the
 *   triangle: by `longest`, the longest edge of a box in the world, over that component, and 2 x 16 u A for the slabs' widening in the
 *   world. Whatever is compared with the best t is granted this. */
#ifndef EC_LIB_TRAVERSE_TWOLEVEL_H
#define EC_LIB_TRAVERSE_TWOLEVEL_H

#include "instance.h"
#include "node8.h"

/* An instance that the ray is in. */
typedef struct visit {
    global const ec_instance *at; /* 0: in the world */
    ray8 q;                       /* the ray in its space, of which only the slabs are set */
    float late;                   /* how much later than a hit the ray may enter the box that holds it */
    uint base;                    /* depth of the stack when the instance was entered */
} visit;

EC_FN float visit_row(global const float *m, float x, float y, float z) { return fma(m[0], x, fma(m[1], y, m[2] * z)); }

/* Makes the slabs of one axis. off: how far the ray may be from its computed place. */
EC_FN void visit_axis(float o, float d, float d_min, float off, float8 *inverse, float8 *near_offset, float8 *far_offset)
{
    float i = copysign(1.0f / max(fabs(d), d_min), d), offset = -(o * i), widen = fabs(off * i);
    *inverse = (float8)(i);
    *near_offset = (float8)(offset - widen);
    *far_offset = (float8)(offset + widen);
}

EC_FN void visit_enter(visit *v, global const ec_instance *n, const ray8 *q)
{
    float x = q->r.o.x.s0, y = q->r.o.y.s0, z = q->r.o.z.s0, dx = q->r.d.x.s0, dy = q->r.d.y.s0, dz = q->r.d.z.s0;
    float reach = max(max(fabs(x), fabs(y)), fabs(z)) + n->reach;
    float d_most = max(max(fabs(dx), fabs(dy)), fabs(dz));
    x -= n->place[0][3];
    y -= n->place[1][3];
    z -= n->place[2][3];
    float ix = visit_row(n->inverse[0], dx, dy, dz), iy = visit_row(n->inverse[1], dx, dy, dz),
          iz = visit_row(n->inverse[2], dx, dy, dz);
    float d_min = max(max(fabs(ix), fabs(iy)), fabs(iz)) * 8.6736174e-19f; /* as in ray_make */
    v->at = n;
    visit_axis(visit_row(n->inverse[0], x, y, z), ix, d_min, reach * n->inverse[0][3], &v->q.r.inverse.x,
               &v->q.near_offset_x, &v->q.far_offset_x);
    visit_axis(visit_row(n->inverse[1], x, y, z), iy, d_min, reach * n->inverse[1][3], &v->q.r.inverse.y,
               &v->q.near_offset_y, &v->q.far_offset_y);
    visit_axis(visit_row(n->inverse[2], x, y, z), iz, d_min, reach * n->inverse[2][3], &v->q.r.inverse.z,
               &v->q.near_offset_z, &v->q.far_offset_z);
    ray8_rows(&v->q);
    v->late = (n->longest + reach * (40.0f * EC_ULP)) / d_most;
}

EC_FN v3 visit_corner(global const ec_instance *n, global const ec_tri8 *b, uint corner)
{
    v3 p = tri8_vertex(b, n->turned && corner ? 3u - corner : corner);
    quad m0 = {F(n->place[0][0]), F(n->place[0][1]), F(n->place[0][2]), F(n->place[0][3])};
    quad m1 = {F(n->place[1][0]), F(n->place[1][1]), F(n->place[1][2]), F(n->place[1][3])};
    quad m2 = {F(n->place[2][0]), F(n->place[2][1]), F(n->place[2][2]), F(n->place[2][3])};
    return v3_make(place_row(m0, p), place_row(m1, p), place_row(m2, p));
}

/* Like block8_triangles, but transforms the triangles to the world first. Unused slots are points there too. */
EC_FN void visit_block(const ray8 *q, const hit_filter *filter, global const ec_instance *n, global const ec_tri8 *b,
                       uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    v3 p0 = visit_corner(n, b, 0), p1 = visit_corner(n, b, 1), p2 = visit_corner(n, b, 2);
    uint8 id = *(global const uint8 *)b->id;
    TALLY_TESTS(h, popcount(mask_bits8(id != EC_NO_ID)));
    v3 lo = v3_make(min(p0.x, min(p1.x, p2.x)), min(p0.y, min(p1.y, p2.y)), min(p0.z, min(p1.z, p2.z)));
    v3 hi = v3_make(max(p0.x, max(p1.x, p2.x)), max(p0.y, max(p1.y, p2.y)), max(p0.z, max(p1.z, p2.z)));
    block8_corners(q, filter, p0, p1, p2, lo, hi, TRUE_MASK, id + n->id, skip0, skip1, any_hit, h);
}

EC_FN void twolevel_leaf(const accel *a, const ray8 *q, const visit *v, const hit_filter *filter, uint child,
                         uint skip0, uint skip1, bool any_hit, hit8 *h)
{
    global const ec_tri8 *blocks = a->at[1];
    if (v->at) visit_block(q, filter, v->at, blocks + (child & ~EC_LEAF_BIT), skip0, skip1, any_hit, h);
    else leaf8(a, q, filter, child, skip0, skip1, any_hit, h);
}

/* Enters the instance that `child` is, if it is one. Returns what to visit: the instance's root, or `child`. */
EC_FN uint visit_begin(visit *v, const accel *a, const ray8 *q, uint child, uint depth)
{
    const uint instance = EC_LEAF_BIT | EC_INSTANCE_BIT;
    global const ec_instance *instances = a->at[3];
    if (v->at || (child & instance) != instance) return child;
    visit_enter(v, instances + (child & ~instance), q);
    v->base = depth;
    return v->at->root;
}

/* Goes back to the world once all of the instance's tree is done. */
EC_FN void visit_end(visit *v, uint depth)
{
    if (!v->at || depth != v->base) return;
    v->at = 0;
    v->late = 0.0f;
}

EC_FN void twolevel_closest(const accel *a, const ray8 *q, const hit_filter *filter, uint skip0, uint skip1, hit8 *h)
{
    global const ec_bvh8_node *nodes = a->at[0];
    global const ec_instance *instances = a->at[3];
    ulong stack[EC_TWOLEVEL_STACK];
    uint depth = 0, current = 0;
    visit v;
    v.at = 0;
    v.late = 0.0f;
    if (instances) stack[depth++] = instances->root; /* visited after the world's own triangles */
    for (;;) {
        current = visit_begin(&v, a, q, current, depth);
        if (current & EC_LEAF_BIT) {
            twolevel_leaf(a, q, &v, filter, current, skip0, skip1, false, h);
        } else {
            global const ec_bvh8_node *n = nodes + current;
            TALLY_NODE(h);
            int8 meets;
            ulong entry[8];
            float8 near = node8_near(v.at ? &v.q : q, n, h->t + v.late, &meets);
            uint mask = mask_bits8(meets);
            vstore8(entries8(near, *(global const uint8 *)n->child), 0, entry);
            if (mask) {
                ulong nearest = entry[lowest_bit(mask)];
                uint first = depth;
                for (mask &= mask - 1; mask; mask &= mask - 1) { /* the others by insertion, the nearest last */
                    ulong next = entry[lowest_bit(mask)], far = max(nearest, next);
                    nearest = min(nearest, next);
                    uint k = depth++;
                    for (; k > first && stack[k - 1] < far; k--) stack[k] = stack[k - 1];
                    stack[k] = far;
                }
                current = (uint)nearest;
                continue;
            }
        }
        do {
            visit_end(&v, depth);
            if (depth == 0) return;
            depth--;
        } while ((uint)(stack[depth] >> 32) > as_uint(h->t + v.late));
        current = (uint)stack[depth];
    }
}

EC_FN bool twolevel_any(const accel *a, const ray8 *q, const hit_filter *filter, uint skip0, uint skip1, hit8 *h)
{
    global const ec_bvh8_node *nodes = a->at[0];
    global const ec_instance *instances = a->at[3];
    uint stack[EC_TWOLEVEL_STACK];
    uint depth = 0, current = 0;
    visit v;
    v.at = 0;
    v.late = 0.0f;
    if (instances) stack[depth++] = instances->root;
    for (;;) {
        current = visit_begin(&v, a, q, current, depth);
        if (current & EC_LEAF_BIT) {
            twolevel_leaf(a, q, &v, filter, current, skip0, skip1, true, h);
            if (h->prim != EC_NO_ID) return true;
        } else {
            TALLY_NODE(h);
            depth += node8_push(v.at ? &v.q : q, nodes + current, h->t + v.late, stack + depth);
        }
        visit_end(&v, depth);
        if (depth == 0) return false;
        current = stack[--depth];
    }
}

#define ACCEL twolevel
#include "trace_rays.h"
#undef ACCEL

#endif
