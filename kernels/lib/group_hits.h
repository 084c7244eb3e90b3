/* Groups hits by material, and with them what rays missed. After a bounce neighbours in the queue hit different things, and a packet runs the code that
 * any of its lanes needs. The order in which a queue is shaded changes no bit of a picture. */
#ifndef EC_LIB_GROUP_HITS_H
#define EC_LIB_GROUP_HITS_H

#include "geometry.h"
#include "queue.h"

#define EC_GROUPS 32u /* the last one is of rays that hit nothing; materials have the others by turns */

/* Sets order to the numbers of the `count` entries from `first` on, group by group and ascending within one, then to `first` up to the end of the last
 * packet. order has room for a packet more. Returns false if all entries are of one group; order is not set then. */
EC_FN bool group_hits(const geometry *g, global const float *hits, uint wave, uint first, uint count, uint *order)
{
    uint groups[EC_ORDERED], n = 0;
    lane_u all = U(0); /* a bit a group */
    for (uint i = 0; i < count; i += LANES) {
        lane_u prim = queue_load_u(hits, wave, EC_HIT_PRIM, first + i);
        lane_i is = LANE_NUMBERS < count - i, found = is & (prim != EC_NO_ID);
        lane_u material = as_lane_u(gather_f(g->prims + 3, geometry_prim(g, found ? prim : U(0)) * EC_PRIM_WORDS));
        lane_u group = is ? U(1) << (found ? material % (EC_GROUPS - 1u) : U(EC_GROUPS - 1u)) : U(0);
        LANE_STORE(group, groups + i);
        all |= group;
    }
    uint left = or_of_lanes(all);
    if (popcount(left) < 2u) return false;
    for (; left; left &= left - 1u) {
        uint group = left & (0u - left);
        for (uint i = 0; i < count; i += LANES) {
            uint bits = mask_bits(LANE_LOAD(groups + i) == group);
            store_packed(order + n, LANE_NUMBERS + (first + i), bits);
            n += popcount(bits);
        }
    }
    LANE_STORE(U(first), order + n);
    return true;
}

#endif
