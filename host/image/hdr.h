/* Radiance pictures (.hdr); see ec_image_read_rgb for the caller's view. */
#ifndef EC_IMAGE_HDR_H
#define EC_IMAGE_HDR_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/error.h"

/* rgb: malloc'ed, 3 floats a pixel. `file` stands at its beginning and stays open. */
ec_result ec_hdr_read(FILE *file, const char *path, uint32_t *width, uint32_t *height, float **rgb, ec_error *err);

/* Does its header say that what is stored was multiplied, by anything but 1? */
bool ec_hdr_has_exposure(const char *path);

#endif
