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

/* 1 where the short table's entry, first number or share differs from the guided one's. */
kernel void pick_few(uint n, global const uint *table, uint entries, global const uint *r, global uint *other)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    lane_u first, share, first_few, share_few, numbers = LANE_LOAD(r + at);
    lane_u entry = distribution_pick(table, U(0), entries, numbers, &first, &share);
    lane_u few = distribution_pick_few(table, entries, numbers, &first_few, &share_few);
    LANE_STORE((entry != few) | (first != first_few) | (share != share_few) ? U(1) : U(0), other + at);
}
