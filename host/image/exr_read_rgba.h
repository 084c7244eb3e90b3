/* Reads the files that OpenEXRCore 3.1 cannot decode; see ec_exr_read. */
#ifndef EC_IMAGE_EXR_READ_RGBA_H
#define EC_IMAGE_EXR_READ_RGBA_H

#include "image/image.h"

/* Fills the planes named R, G, B and A of an image of the given size and origin; leaves others alone. */
ec_result ec_exr_read_rgba(const char *path, int32_t origin_x, int32_t origin_y, ec_exr *exr, ec_error *err);

#endif
