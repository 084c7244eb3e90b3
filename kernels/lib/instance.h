/* Where a mesh that is kept once stands. A corner is taken to the world by fma in one fixed order, and everything else (watertight
 * edges, error bounds, ties) begins there: a triangle that two instances or a hundred share is, at each place, the one that
 * host/scene/write_out.c would have written there, bit for bit. */
#ifndef EC_LIB_INSTANCE_H
#define EC_LIB_INSTANCE_H

#include "../shared/scene_buffers.h"
#include "math.h"

/* A row of a matrix in a, b, c, d, for each lane its own or the same for all. */
EC_FN lane_f place_row(quad m, v3 p) { return fma(m.a, p.x, fma(m.b, p.y, fma(m.c, p.z, m.d))); }
EC_FN lane_f place_row_direction(quad m, v3 p) { return fma(m.a, p.x, fma(m.b, p.y, m.c * p.z)); }

/* Has a triangle in the world nothing left that has a normal? Its corners may have been rounded into a line. */
EC_FN lane_i place_leaves_flat(v3 p0, v3 p1, v3 p2)
{
    v3 n = v3_abs(v3_cross(v3_sub(p1, p0), v3_sub(p2, p0)));
    return !(v3_max_component(n) >= 1.17549435e-38f);
}

/* Which lanes' triangles are an instance's, and where it stands: its ec_place at word *at of `places`. Returns the triangle's ec_prim.
 * turned: corners 1 and 2 change places. */
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

/* A mesh's point in the world. */
EC_FN v3 instance_point(global const float *places, lane_u at, v3 p)
{
    return v3_make(place_row(gather_quad(places, at), p), place_row(gather_quad(places, at + 4u), p),
                   place_row(gather_quad(places, at + 8u), p));
}

/* A mesh's triangle in the world, on lanes `placed`; turned, at: as instance_find has them. */
EC_FN void instance_corners(global const float *places, lane_i placed, lane_i turned, lane_u at, v3 *p0, v3 *p1, v3 *p2)
{
    v3 second = v3_select(turned, *p2, *p1), third = v3_select(turned, *p1, *p2);
    *p0 = v3_select(placed, instance_point(places, at, *p0), *p0);
    *p1 = v3_select(placed, instance_point(places, at, second), *p1);
    *p2 = v3_select(placed, instance_point(places, at, third), *p2);
}

/* Unit length, or 0 where it was. word: 0 turns tangents, EC_PLACE_NORMAL normals. */
EC_FN v3 instance_direction(global const float *places, lane_u at, uint word, v3 d)
{
    v3 r = v3_make(place_row_direction(gather_quad(places, at + word), d),
                   place_row_direction(gather_quad(places, at + word + 4u), d),
                   place_row_direction(gather_quad(places, at + word + 8u), d));
    lane_f length2 = v3_dot(r, r);
    return v3_scale(r, length2 > 0.0f ? 1.0f / sqrt(length2) : F(0.0f));
}

#endif
