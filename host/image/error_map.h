/* A map of the differences between two pictures. */
#ifndef EC_IMAGE_ERROR_MAP_H
#define EC_IMAGE_ERROR_MAP_H

#include <stdint.h>

/* Returns the perceptually uniform colour map magma: 0 is black, 1 pale yellow; values outside are clamped. */
void ec_magma(double x, uint8_t rgb[3]);

/* Shows each pixel's difference (root mean square of the channels) relative to b's luminance + 0.01 in magma on a logarithmic scale: 0.1 % and less
 * is black, 100 % and more pale yellow. The scale is fixed, so that maps can be compared. a, b: 3 floats per pixel; out: 3 bytes. */
void ec_error_map(const float *a, const float *b, uint64_t pixel_count, uint8_t *out);

#endif
