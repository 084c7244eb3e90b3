/* Places samples in and beside a pixel: importance sampling of the pixel filter (Ernst, Stamminger, Greiner 2006). All samples of a pixel weigh the
 * same, and none counts in two pixels: a pixel's samples stay independent of each other and of those of its neighbours, as the stated error assumes. */
#ifndef EC_LIB_PIXEL_FILTER_H
#define EC_LIB_PIXEL_FILTER_H

#include "../shared/features.h"
#include "../shared/pixel_filter.h"
#include "math.h"

/* Maps u in [0, 1) to a distance from the pixel's lower edge, in pixels. table: NULL for a box of one pixel. */
EC_FN lane_f pixel_filter_place(global const float *table, lane_f u)
{
    if (!HAS(PIXEL_FILTER) || !table) return u;
    lane_f tail = u < 0.5f ? u : 1.0f - u;
    lane_f at = sqrt(sqrt(2.0f * tail)) * (float)EC_FILTER_STEPS;
    lane_f below = min(floor(at), F(EC_FILTER_STEPS - 1.0f));
    lane_u entry = int_to_lane_u(to_lane_i(below));
    lane_f near = gather_f(table, entry + 1u), far = gather_f(table, entry);
    lane_f distance = fma(at - below, near - far, far);
    return 0.5f + (u < 0.5f ? -distance : distance);
}

/* Returns the filter's density at this distance from the pixel's centre, along one axis. */
EC_FN lane_f pixel_filter_density(global const float *table, lane_f distance)
{
    lane_u low = U(0); /* table[low] > distance >= table[low + 1]: entries fall */
    for (uint step = EC_FILTER_STEPS / 2; step; step /= 2) {
        lane_u middle = low + step;
        low = gather_f(table, middle) > distance ? middle : low;
    }
    lane_f far = gather_f(table, low), near = gather_f(table, low + 1u), width = far - near;
    lane_f at = (to_lane_f(low) + (far - distance) / width) / (float)EC_FILTER_STEPS;
    return ((distance < table[0]) & (width > 0.0f)) ? 2.0f * at * at * at / ((float)EC_FILTER_STEPS * width) : F(0.0f);
}

/* Chooses a pixel that a place in the picture (in pixels) counts for, along one axis: u in [0, 1) chooses by the densities of the pixels' filters
 * there, whose sum is *weight. With a box filter it is the pixel in which the place lies. */
EC_FN lane_f pixel_filter_choose(global const float *table, lane_f place, lane_f u, lane_f *weight)
{
    *weight = F(1.0f);
    if (!HAS(PIXEL_FILTER) || !table) return floor(place);
    lane_f first = ceil(place - 0.5f - table[0]), sum = F(0.0f), chosen = first;
    uint count = (uint)(2.0f * table[0]) + 2u;
    EC_LOOP
    for (uint k = 0; k < count; k++) sum += pixel_filter_density(table, fabs(place - (first + (float)k) - 0.5f));
    lane_f goal = u * sum, before = F(0.0f);
    EC_LOOP
    for (uint k = 0; k < count; k++) {
        lane_f density = pixel_filter_density(table, fabs(place - (first + (float)k) - 0.5f));
        chosen = ((goal >= before) & (density > 0.0f)) ? first + (float)k : chosen;
        before += density;
    }
    *weight = sum;
    return chosen;
}

#endif
