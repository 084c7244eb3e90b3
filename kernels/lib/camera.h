/* Places a sample in the picture. */
#ifndef EC_LIB_CAMERA_H
#define EC_LIB_CAMERA_H

#include "film.h"
#include "pixel_filter.h"
#include "sampler.h"

/* Sets the pixel (*x, *y), counted from the top left, and the sample's place in the picture: *sx, *sy in [-1, 1], *sy up, unless a screen window
 * shows another part; a filter wider than a pixel reaches beyond the edges. Returns the sampler. filter: table of pixel_filter.h, or NULL. */
EC_FN sampler camera_sample(constant ec_params *params, uint seed, uint first_pixel, global const uint *pixel_list,
                            global const float *filter, lane_u slot, lane_u *x, lane_u *y, lane_f *sx, lane_f *sy)
{
    lane_u pixel, sample;
    slot_to_pixel(params, first_pixel, pixel_list, slot, &pixel, &sample);
    pixel_to_xy(params, pixel, x, y);
    sampler random = sampler_make(seed, pixel, sample);
    lane_f jx, jy;
    sample_pair(random, EC_PAIR_PIXEL, &jx, &jy);
    jx = pixel_filter_place(filter, jx);
    jy = pixel_filter_place(filter, jy);
    *sx = fma(to_lane_f(*x) + jx, F(params->screen[2]), F(params->screen[0]));
    *sy = fma(to_lane_f(*y) + jy, F(params->screen[3]), F(params->screen[1]));
    return random;
}

#endif
