/* A picture of where two pictures differ. */
#ifndef EC_IMAGE_ERROR_MAP_H
#define EC_IMAGE_ERROR_MAP_H

#include <stdint.h>

/* The colour map magma, perceptually uniform: 0 black, 1 pale yellow; beyond them the ends. */
void ec_magma(double x, uint8_t rgb[3]);

/* Each pixel's difference (root mean square of the channels) relative to b's luminance + 0.01, in magma on a logarithmic scale:
 * 0.1 % and less black, 100 % and more pale yellow. A fixed scale, so that maps compare. a, b: 3 floats a pixel; out: 3 bytes. */
void ec_error_map(const float *a, const float *b, uint64_t pixel_count, uint8_t *out);

#endif
