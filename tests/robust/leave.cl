/* Makes rays that leave surfaces, as the shading stages do, for leave.h. */
#include "lib/queue.h"
#include "lib/ray.h"
#include "lib/surface.h"
#include "leave_fields.h"

/* Reads hits and the paths' directions; writes the paths' origins, and EC_LEAVE_FIELDS about the points of departure. */
kernel void leave(uint wave, float scene_max, global const float *prims, global const float *hits, global float *paths,
                              global float *left)
{
    uint i = get_global_id(0) * LANES;
    if (i >= wave) return;
    geometry g = {prims, 0, 0, 0, 0, 0, 0, {0, 0, 0}, 0};
    hit_point h = hit_point_make(&g, queue_load_u(hits, wave, EC_HIT_PRIM, i), queue_load_f(hits, wave, EC_HIT_B1, i),
                                 queue_load_f(hits, wave, EC_HIT_B2, i));
    v3 d = queue_load_v3(paths, wave, EC_PATH_DX, i);
    surface s;
    surface_place(&h, d, &s);
    v3 o = surface_offset(s.p, s.p_error, s.ng, d);
    ray r = ray_make(o, d, scene_max);
    edges e;
    lane_f inverse, t;
    lane_i again = ray_meets(&r, h.p0, h.p1, h.p2, &e, &inverse, &t); /* no bounding box, no skipped triangle */
    queue_store_v3(paths, wave, EC_PATH_OX, i, o);
    queue_store_v3(left, wave, EC_LEAVE_P, i, s.p);
    queue_store_v3(left, wave, EC_LEAVE_ERROR, i, s.p_error);
    queue_store_f(left, wave, EC_LEAVE_AGAIN, i, again ? F(1.0f) : F(0.0f));
}
