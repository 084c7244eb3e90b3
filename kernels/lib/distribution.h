/* A discrete distribution by its inverse: neighbouring numbers pick neighbours, so that what is even in a sampler stays even. */
#ifndef EC_LIB_DISTRIBUTION_H
#define EC_LIB_DISTRIBUTION_H

#include "../shared/scene_buffers.h"
#include "lanes.h"
#include "math.h"

/* Which of the n entries from table[at] on the number r picks, and what is left of r: where in its share it lies, in [0, 1). The
 * guide bounds a bisection, of few steps unless shares differ a lot. */
EC_FN lane_u distribution_sample(global const uint *table, lane_u at, uint n, lane_u r, lane_f *left)
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
    lane_u first = gather_u(table, (at + low) * 2u), next = gather_u(table, (at + (is_last ? low : low + 1u)) * 2u);
    lane_u share = (is_last ? U(0) : next) - first; /* 0 is 2^32 */
    lane_f all = share == 0u ? F(4294967296.0f) : to_lane_f(share);
    *left = min((to_lane_f(r - first) + 0.5f) / all, F(0.99999994f));
    return low;
}

#endif
