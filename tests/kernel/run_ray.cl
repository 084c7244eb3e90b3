/* One ray and one triangle in each lane, for comparison with double precision on the host. */
#include "lib/ray.h"

static v3 load_v3(global const float *p, uint n) { return v3_make(LANE_LOAD(p), LANE_LOAD(p + n), LANE_LOAD(p + 2 * n)); }

/* Rays (o, d) and triangles (v0, v1, v2), structures of arrays of n. hit: t or -1, b1, b2, front. */
kernel void intersection_of(uint n, float scene_max, global const float *rays, global const float *triangles, global float *hit)
{
    uint at = get_global_id(0) * LANES;
    ray r = ray_make(load_v3(rays + at, n), load_v3(rays + 3 * n + at, n), scene_max);
    v3 v0 = load_v3(triangles + at, n), v1 = load_v3(triangles + 3 * n + at, n), v2 = load_v3(triangles + 6 * n + at, n);
    edges e;
    lane_f t, inverse;
    lane_i m = ray_meets(&r, v0, v1, v2, &e, &inverse, &t);
    v3 lo = v3_make(min(v0.x, min(v1.x, v2.x)), min(v0.y, min(v1.y, v2.y)), min(v0.z, min(v1.z, v2.z)));
    v3 hi = v3_make(max(v0.x, max(v1.x, v2.x)), max(v0.y, max(v1.y, v2.y)), max(v0.z, max(v1.z, v2.z)));
    m = m & reference_clamp(&r, lo, hi, F(EC_HUGE), &t);
    LANE_STORE(m ? t : F(-1.0f), hit + at);
    LANE_STORE(m ? e.v * inverse : F(0.0f), hit + n + at);
    LANE_STORE(m ? e.w * inverse : F(0.0f), hit + 2 * n + at);
    LANE_STORE((m & edges_front(&r, &e)) ? F(1.0f) : F(0.0f), hit + 3 * n + at);
}
