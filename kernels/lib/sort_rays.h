/* Sorts rays so that those that go the same way from the same place are neighbours: after a bounce the rays of a packet scatter, and a packet visits
 * what any of its rays visits. Which rays share a packet changes no hit (ray.h). */
#ifndef EC_LIB_SORT_RAYS_H
#define EC_LIB_SORT_RAYS_H

#include "queue.h"

EC_FN lane_u octant(v3 v) { return (as_lane_u(v.x) >> 31) | (as_lane_u(v.y) >> 31) << 1 | (as_lane_u(v.z) >> 31) << 2; }

/* Returns a ray's bin, of octants of the origin about the scene's centre and of the direction. Neighbouring bins differ in one sign (Gray's code),
 * since packets straddle them. */
EC_FN lane_u ray_bin(v3 o, v3 d)
{
    lane_u bin = octant(o) << 3 | octant(d);
    bin ^= bin >> 1;
    bin ^= bin >> 2;
    return bin ^ bin >> 4;
}

/* Sets order to the numbers of the `count` entries from `first` on, by bin and by number within a bin, then to `first` up to the end of the last
 * packet. origin, direction: their fields in the queue. */
EC_FN void sort_rays(global const float *queue, uint wave, uint origin, uint direction, uint first, uint count, uint *order)
{
    uint bins[EC_ORDERED], at[64], sum = 0; /* 16 rays in each of 64 bins, were they spread evenly */
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

/* Returns how many of the `left` rays from entry i on the work-item traces: a packet or, with sorts, up to EC_ORDERED, whose order it sets, and none
 * for the work-items in between. */
EC_FN uint item_rays(uint left, global const float *queue, uint wave, uint part, uint origin, uint direction, uint i, bool sorts, uint *order)
{
    if (!sorts) return min(left, (uint)LANES);
    left = ordered_entries(left, part, i);
    if (left) sort_rays(queue, wave, origin, direction, i, left, order);
    return left;
}

#endif
