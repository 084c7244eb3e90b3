/* Reads and writes Radiance pictures (.hdr); callers use ec_image_read_rgb. */
#ifndef EC_IMAGE_HDR_H
#define EC_IMAGE_HDR_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/error.h"

/* Reads from the beginning of `file`, which stays open. *rgb is malloc'ed, 3 floats per pixel. */
ec_result ec_hdr_read(FILE *file, const char *path, uint32_t *width, uint32_t *height, float **rgb, ec_error *err);

/* Tells whether the header says that values were multiplied by anything but 1. */
bool ec_hdr_has_exposure(const char *path);

#endif
