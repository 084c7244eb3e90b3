/* lib/distribution.h on arrays, for test_distribution.c. */
#include "lib/distribution.h"

kernel void sample_distribution(uint n, global const uint *table, uint entries, global const uint *r, global uint *entry, global float *left)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    lane_f rest;
    LANE_STORE(distribution_sample(table, U(0), entries, LANE_LOAD(r + at), &rest), entry + at);
    LANE_STORE(rest, left + at);
}
