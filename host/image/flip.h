/* Measures how different two pictures look. */
#ifndef EC_IMAGE_FLIP_H
#define EC_IMAGE_FLIP_H

#include <stdint.h>

#include "base/error.h"

#define EC_FLIP_PPD 67.0206 /* pixels per degree: a screen 3840 pixels and 0.7 m wide, seen from 0.7 m */

/* LDR-FLIP of Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild, "FLIP: A Difference Evaluator for Alternating Images" (2020): per
 * pixel from 0, alike, to 1. a, b: sRGB values from 0 to 1, 3 floats per pixel. map: 1 float per pixel. */
ec_result ec_flip(const float *a, const float *b, uint32_t width, uint32_t height, float *map, ec_error *err);

/* Structural similarity of luma (Rec. 709's weights): Wang, Bovik, Sheikh and Simoncelli, "Image quality assessment: from error visibility to
 * structural similarity" (2004), windows of 11 x 11, deviation 1.5, K 0.01 and 0.03. Returns the mean over windows inside the picture whose middle
 * counts (mask: 1 byte per pixel, or NULL); NaN: there is none. */
double ec_ssim(const float *a, const float *b, uint32_t width, uint32_t height, const uint8_t *mask);

#endif
