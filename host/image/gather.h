/* Gathers the rows of a picture for a format whose library takes it as a whole. */
#ifndef EC_IMAGE_GATHER_H
#define EC_IMAGE_GATHER_H

#include "image/image.h"

/* Encodes a whole picture; *bytes is malloc'ed. Returns NULL, or the reason of a failure. 16-bit values have the high byte first. */
typedef const char *ec_encode(const ec_raster *of, const uint8_t *pixels, uint8_t **bytes, size_t *size);

/* As in ec_format. */
ec_result ec_gather_begin(ec_encode *encode, void **rows, const char *path, const ec_raster *of, ec_error *err);
ec_result ec_gather_put(void *rows, const void *pixels, uint32_t count, ec_error *err);
ec_result ec_gather_end(void *rows, ec_error *err);
void ec_gather_abort(void *rows);

/* codecs/: NULL if the build lacks the library. */
extern ec_encode *const ec_encode_avif; /* quality about 90, full-resolution colours, lossless alpha */
extern ec_encode *const ec_encode_jxl;  /* lossless */

#endif
