/* Rays that go the same way from the same place side by side: after a bounce those of one packet scatter, and a packet visits what any of
 * its rays visits. Which rays share a packet changes no hit (ray.h). */
#ifndef EC_LIB_SORT_RAYS_H
#define EC_LIB_SORT_RAYS_H

#include "queue.h"

#define EC_SORTED 1024u /* rays that one work-item puts in order: 16 in each of 64 bins, were they spread evenly */

EC_FN lane_u octant(v3 v) { return (as_lane_u(v.x) >> 31) | (as_lane_u(v.y) >> 31) << 1 | (as_lane_u(v.z) >> 31) << 2; }

/* Octants of the origin about the scene's centre and of the direction. Neighbouring bins differ in one sign (Gray's code): packets straddle
 * them. */
EC_FN lane_u ray_bin(v3 o, v3 d)
{
    lane_u bin = octant(o) << 3 | octant(d);
    bin ^= bin >> 1;
    bin ^= bin >> 2;
    return bin ^ bin >> 4;
}

/* order: numbers of the `count` entries from `first` on, bin by bin and by number within a bin, and `first` up to the end of the last packet.
 * origin, direction: the queue's fields of them. */
EC_FN void sort_rays(global const float *queue, uint wave, uint origin, uint direction, uint first, uint count, uint *order)
{
    uint bins[EC_SORTED], at[64], sum = 0;
    for (uint k = 0; k < 64; k++) at[k] = 0;
    for (uint i = 0; i < count; i += LANES)
        LANE_STORE(ray_bin(queue_load_v3(queue, wave, origin, first + i),
                           queue_load_v3(queue, wave, direction, first + i)),
                   bins + i);
    for (uint i = 0; i < count; i++) at[bins[i]]++;
    for (uint k = 0; k < 64; k++) {
        uint in_bin = at[k];
        at[k] = sum;
        sum += in_bin;
    }
    for (uint i = 0; i < count; i++) order[at[bins[i]]++] = first + i;
    for (uint i = count; i % LANES; i++) order[i] = first;
}

/* The rays of the work-item at entry i, of `left`: a packet, or, sorted, EC_SORTED from there on, and none for those in between. Returns how many. */
EC_FN uint item_rays(uint left, global const float *queue, uint wave, uint part, uint origin, uint direction, uint i, bool sorts, uint *order)
{
    if (!sorts) return min(left, (uint)LANES);
    if (i % part % EC_SORTED) return 0;
    left = min(left, EC_SORTED);
    sort_rays(queue, wave, origin, direction, i, left, order);
    return left;
}

#endif
