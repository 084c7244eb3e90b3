/* The curve of sRGB (IEC 61966-2-1) on [0, 1]. */
#ifndef EC_IMAGE_SRGB_H
#define EC_IMAGE_SRGB_H

#include <stdint.h>

double ec_srgb_to_linear(double encoded);
double ec_srgb_encode(double linear);
const double *ec_srgb_bytes(void); /* table of ec_srgb_to_linear(i / 255.0), 256 values: a power takes as long as twenty look-ups */

/* Returns lrint(255 * ec_srgb_encode(x)) by look-up. */
typedef struct ec_srgb_rounder ec_srgb_rounder;
const ec_srgb_rounder *ec_srgb_get_rounder(void);
uint8_t ec_srgb_round(const ec_srgb_rounder *, double linear);

#endif
