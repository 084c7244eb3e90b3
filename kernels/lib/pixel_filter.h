/* Where in a pixel, and beside it, a sample lies: importance sampling of the pixel filter (Ernst, Stamminger, Greiner 2006). All
 * samples of a pixel weigh the same, and none counts in two pixels: a pixel's samples stay independent of each other and of
 * those of its neighbours, which is what the stated error takes them for. */
#ifndef EC_LIB_PIXEL_FILTER_H
#define EC_LIB_PIXEL_FILTER_H

#include "../shared/features.h"
#include "../shared/pixel_filter.h"
#include "math.h"

/* u in [0, 1) to pixels from the pixel's lower edge. table: NULL for a box of one pixel. */
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

#endif
