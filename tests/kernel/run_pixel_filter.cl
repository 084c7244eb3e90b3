/* Positions of samples in pixels, for test_pixel_filter.c. */
#include "lib/sampler.h"
#include "lib/pixel_filter.h"

kernel void places(global const float *table, uint seed, global float *out)
{
    uint at = get_global_id(0) * LANES;
    LANE_STORE(pixel_filter_place(table, to_unit(hash_u(hash_u(LANE_NUMBERS + at) ^ seed))), out + at);
}
