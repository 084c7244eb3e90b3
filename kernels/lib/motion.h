/* Motion while the shutter is open. A path has one time in [0, 1), stored with its sample's slot; triangles, normals and lamps are where they are
 * then. Keys are at equal intervals, whose number is a power of two, so that the time's fraction of an interval is exact.
 *
 * A corner is fma(f, b - a, a) between its keys a and b, f at most 1 - u: three roundings of monotone functions, which never lead beyond a or b. So
 * it lies within the box over all keys by which accelerators know the triangle. Neighbours share the bits of their corners, and a corner that stands
 * still keeps its own. Traversals and shading make corners here and nowhere else. */
#ifndef EC_LIB_MOTION_H
#define EC_LIB_MOTION_H

#include "../shared/scene_buffers.h"
#include "math.h"

/* A time as the key before it and the fraction of the way to the next. */
typedef struct moment {
    lane_u key;
    lane_f share;
} moment;

EC_FN moment moment_of(global const float *motion, lane_f time)
{
    moment t;
    lane_f ways = time * to_lane_f(U(((global const uint *)motion)[EC_MOTION_SEGMENTS]));
    lane_i key = to_lane_i(ways);
    t.key = int_to_lane_u(key);
    t.share = ways - int_to_lane_f(key);
    return t;
}

/* Returns the moment at which the shutter closes. */
EC_FN moment moment_of_end(global const float *motion)
{
    moment t = {U(((global const uint *)motion)[EC_MOTION_SEGMENTS] - 1u), F(1.0f)};
    return t;
}

/* Returns item `thing` of a stream at a moment. stream: the header's word that says where it begins (EC_MOTION_POSITIONS, …). */
EC_FN v3 motion_point(global const float *motion, uint stream, lane_u thing, moment t)
{
    global const uint *head = (global const uint *)motion;
    lane_u at = head[stream] + (thing * (head[EC_MOTION_SEGMENTS] + 1u) + t.key) * 4u;
    quad a = gather_quad(motion, at), b = gather_quad(motion, at + 4u);
    return v3_make(fma(t.share, b.a - a.a, a.a), fma(t.share, b.b - a.b, a.b), fma(t.share, b.c - a.c, a.c));
}

EC_FN lane_i motion_moves(global const float *motion, lane_u prim)
{
    return prim < ((global const uint *)motion)[EC_MOTION_TRIANGLES];
}

/* Sets the corners to those of triangle prim at the moment, on the lanes m. */
EC_FN void motion_corners_at(global const float *motion, moment t, lane_i m, lane_u prim, v3 *p0, v3 *p1, v3 *p2)
{
    quad corner = gather_quad(motion, (m ? prim : U(0)) * 4u + EC_MOTION_HEADER);
    *p0 = v3_select(m, motion_point(motion, EC_MOTION_POSITIONS, as_lane_u(corner.a), t), *p0);
    *p1 = v3_select(m, motion_point(motion, EC_MOTION_POSITIONS, as_lane_u(corner.b), t), *p1);
    *p2 = v3_select(m, motion_point(motion, EC_MOTION_POSITIONS, as_lane_u(corner.c), t), *p2);
}

EC_FN void motion_corners(global const float *motion, lane_f time, lane_i m, lane_u prim, v3 *p0, v3 *p1, v3 *p2)
{
    motion_corners_at(motion, moment_of(motion, time), m, prim, p0, p1, p2);
}

/* Returns a vertex's normal or tangent at the time, a little shorter than 1 between keys; d where the vertex stands still. */
EC_FN v3 motion_direction(global const float *motion, lane_f time, uint stream, lane_u vertex, v3 d)
{
    lane_i m = vertex < ((global const uint *)motion)[EC_MOTION_VERTICES];
    if (!any_lane(m)) return d;
    return v3_select(m, motion_point(motion, stream, m ? vertex : U(0), moment_of(motion, time)), d);
}

/* Returns 1 / area of a triangle. */
EC_FN lane_f motion_per_area(v3 p0, v3 p1, v3 p2)
{
    v3 n = v3_cross(v3_sub(p1, p0), v3_sub(p2, p0));
    return 2.0f / sqrt(v3_dot(n, n));
}

#endif
