/* Samples a discrete distribution by inversion: neighbouring numbers pick neighbouring entries, so that evenly spread samples stay so. */
#ifndef EC_LIB_DISTRIBUTION_H
#define EC_LIB_DISTRIBUTION_H

#include "../shared/scene_buffers.h"
#include "choice.h"

/* Returns which of the n entries from table[at] on the number r picks. The entry's share of the 32-bit numbers begins at *first and has *share of
 * them (0: all 2^32). The guide bounds a bisection, which takes few steps unless shares differ a lot. */
EC_FN lane_u distribution_pick(global const uint *table, lane_u at, uint n, lane_u r, lane_u *first, lane_u *share)
{
    lane_u bucket = mul_hi(r, U(n));
    lane_u high = gather_u(table, (at + bucket) * 2u + 1u);
    lane_u low = gather_u(table, (at + (bucket == 0u ? bucket : bucket - 1u)) * 2u + 1u);
    low = bucket == 0u ? U(0) : low;
    while (any_lane(low < high)) {
        lane_u middle = (low + high + 1u) >> 1u;
        lane_i is_past = gather_u(table, (at + middle) * 2u) > r;
        high = is_past ? middle - 1u : high;
        low = is_past ? low : middle;
    }
    lane_i is_last = low + 1u == n;
    lane_u next = gather_u(table, (at + (is_last ? low : low + 1u)) * 2u);
    *first = gather_u(table, (at + low) * 2u);
    *share = (is_last ? U(0) : next) - *first;
    return low;
}

/* Like distribution_pick, for a short table without empty entries: searches it in order, without gathers. */
EC_FN lane_u distribution_pick_few(global const uint *table, uint n, lane_u r, lane_u *first, lane_u *share)
{
    lane_u entry = U(0), next = U(n > 1u ? table[2] : 0u);
    *first = U(0);
    for (uint i = 1; i < n; i++) {
        uint begins = table[2u * i], ends = i + 1u < n ? table[2u * i + 2u] : 0u;
        lane_i is_past = r >= begins;
        entry = is_past ? U(i) : entry;
        *first = is_past ? U(begins) : *first;
        next = is_past ? U(ends) : next;
    }
    *share = next - *first;
    return entry;
}

/* Like distribution_pick; *left: where r lies in the entry's share, in [0, 1). */
EC_FN lane_u distribution_sample(global const uint *table, lane_u at, uint n, lane_u r, lane_f *left)
{
    lane_u first, share, entry = distribution_pick(table, at, n, r, &first, &share);
    *left = choice_rest(r - first, share, r);
    return entry;
}

#endif
