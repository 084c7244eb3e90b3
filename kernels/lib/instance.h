/* Instances of meshes that are stored once. A corner is transformed to the world by fma in one fixed order, and everything else (watertight edges,
 * error bounds, ties) begins there: at each place, a shared triangle is, bit for bit, the one that host/scene/write_out.c would have written. */
#ifndef EC_LIB_INSTANCE_H
#define EC_LIB_INSTANCE_H

#include "../shared/scene_buffers.h"
#include "math.h"

/* Applies a matrix row (a, b, c, d) to a point; lanes may have different rows. */
EC_FN lane_f place_row(quad m, v3 p) { return fma(m.a, p.x, fma(m.b, p.y, fma(m.c, p.z, m.d))); }
EC_FN lane_f place_row_direction(quad m, v3 p) { return fma(m.a, p.x, fma(m.b, p.y, m.c * p.z)); }

/* Returns the lanes whose triangle has no normal in the world: its corners may have been rounded into a line. */
EC_FN lane_i place_leaves_flat(v3 p0, v3 p1, v3 p2)
{
    v3 n = v3_abs(v3_cross(v3_sub(p1, p0), v3_sub(p2, p0)));
    return !(v3_max_component(n) >= 1.17549435e-38f);
}

/* Sets *placed on lanes whose triangle belongs to an instance, *at to the word of its ec_place in `places`, *turned where corners 1 and 2 change
 * places. Returns the index of the triangle's ec_prim. */
EC_FN lane_u instance_find(global const float *places, lane_u prim, lane_i *placed, lane_u *at, lane_i *turned)
{
    global const uint *words = (global const uint *)places;
    uint count = words[0], step = words[3];
    *placed = prim >= words[1];
    *turned = !TRUE_MASK;
    *at = U(4u);
    if (!any_lane(*placed)) return prim;
    lane_u k = U(0);
    for (; step; step >>= 1) {
        lane_u next = k + step;
        lane_i there = next < count;
        lane_i after = gather_u(words + words[2], there ? next : k) <= prim;
        k = (there & after) ? next : k;
    }
    *at = k * EC_PLACE_WORDS + 4u;
    quad q = gather_quad(places, *at + EC_PLACE_ID);
    *turned = *placed & (as_lane_u(q.c) != 0u);
    return *placed ? prim - as_lane_u(q.a) + as_lane_u(q.b) : prim;
}

/* Transforms a point of a mesh to the world. */
EC_FN v3 instance_point(global const float *places, lane_u at, v3 p)
{
    return v3_make(place_row(gather_quad(places, at), p), place_row(gather_quad(places, at + 4u), p),
                   place_row(gather_quad(places, at + 8u), p));
}

/* Transforms a triangle of a mesh to the world, on the lanes `placed`; turned, at: from instance_find. */
EC_FN void instance_corners(global const float *places, lane_i placed, lane_i turned, lane_u at, v3 *p0, v3 *p1, v3 *p2)
{
    v3 second = v3_select(turned, *p2, *p1), third = v3_select(turned, *p1, *p2);
    *p0 = v3_select(placed, instance_point(places, at, *p0), *p0);
    *p1 = v3_select(placed, instance_point(places, at, second), *p1);
    *p2 = v3_select(placed, instance_point(places, at, third), *p2);
}

/* Transforms a direction to the world; unit length, or 0 where d is. word: 0 for tangents, EC_PLACE_NORMAL for normals. */
EC_FN v3 instance_direction(global const float *places, lane_u at, uint word, v3 d)
{
    v3 r = v3_make(place_row_direction(gather_quad(places, at + word), d),
                   place_row_direction(gather_quad(places, at + word + 4u), d),
                   place_row_direction(gather_quad(places, at + word + 8u), d));
    lane_f length2 = v3_dot(r, r);
    return v3_scale(r, length2 > 0.0f ? 1.0f / sqrt(length2) : F(0.0f));
}

#endif
