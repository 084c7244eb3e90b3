/* lib/guide.h on arrays, for test_guide.c. xyz: by component, n each; u: pairs. */
#include "lib/guide.h"

EC_FN v3 load(global const float *xyz, uint n, uint at) { return v3_make(LANE_LOAD(xyz + at), LANE_LOAD(xyz + n + at), LANE_LOAD(xyz + 2 * n + at)); }

/* Densities of directions at points, and the probability of guiding there. */
kernel void guide_density(uint n, global const float *table, global const float *points, global const float *directions, global float *pdf, global float *share)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    guide g = guide_find(table, TRUE_MASK, load(points, n, at));
    LANE_STORE(guide_pdf(&g, load(directions, n, at)), pdf + at);
    LANE_STORE(g.share, share + at);
}

kernel void guide_directions(uint n, global const float *table, global const float *points, global const float *u, global float *directions)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    guide g = guide_find(table, TRUE_MASK, load(points, n, at));
    v3 w = guide_sample(&g, TRUE_MASK, LANE_LOAD(u + at), LANE_LOAD(u + n + at));
    LANE_STORE(w.x, directions + at);
    LANE_STORE(w.y, directions + n + at);
    LANE_STORE(w.z, directions + 2 * n + at);
}
