/* Tables of pixel filters for the kernels. */
#ifndef EC_DEVICE_PIXEL_FILTER_H
#define EC_DEVICE_PIXEL_FILTER_H

#include "shared/pixel_filter.h"

/* Fills the table of Blackman and Harris' four-term window, which reaches `width` pixels to each side of the pixel's centre. */
void ec_pixel_filter_blackman_harris(double width, float table[EC_FILTER_ENTRIES]);

#endif
