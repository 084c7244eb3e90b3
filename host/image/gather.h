/* Rows of a picture gathered for a format whose library takes it whole. */
#ifndef EC_IMAGE_GATHER_H
#define EC_IMAGE_GATHER_H

#include "image/image.h"

/* A whole picture to the bytes of a file, malloc'ed. NULL: done; else why not. 16 bits: the high byte first. */
typedef const char *ec_encode(const ec_raster *of, const uint8_t *pixels, uint8_t **bytes, size_t *size);

/* As ec_format has them. */
ec_result ec_gather_begin(ec_encode *encode, void **rows, const char *path, const ec_raster *of, ec_error *err);
ec_result ec_gather_put(void *rows, const void *pixels, uint32_t count, ec_error *err);
ec_result ec_gather_end(void *rows, ec_error *err);
void ec_gather_abort(void *rows);

/* codecs/: NULL where the build lacks the library. */
extern ec_encode *const ec_encode_avif; /* quality 90 or so, colours in every pixel, alpha without loss */
extern ec_encode *const ec_encode_jxl;  /* without loss */

#endif
