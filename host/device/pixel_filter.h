/* Pixel filters as the kernels sample them. */
#ifndef EC_DEVICE_PIXEL_FILTER_H
#define EC_DEVICE_PIXEL_FILTER_H

#include "shared/pixel_filter.h"

/* Blackman and Harris' four-term window, `width` pixels to each side of the pixel's centre. */
void ec_pixel_filter_blackman_harris(double width, float table[EC_FILTER_ENTRIES]);

#endif
