/* File formats other than EXR, written row by row from the top, as a table. */
#ifndef EC_IMAGE_FORMATS_H
#define EC_IMAGE_FORMATS_H

#include <stdbool.h>

#include "image/gather.h"

/* begin opens rows, end and abort free them. A file gets its name only once it is complete. */
typedef struct ec_format {
    const char *endings[3]; /* file name extensions, ended by NULL */
    bool has_alpha, has_16_bits, keeps_text;
    ec_encode *const *encode; /* of formats encoded as a whole; points to NULL if the build lacks the library, */
    const char *library;    /* whose name this is */
    bool is_linear;         /* takes radiance, 3 floats per pixel */
    ec_result (*begin)(void **rows, const char *path, const ec_raster *of, const ec_png_text *text, ec_error *err);
    ec_result (*put)(void *rows, const void *pixels, uint32_t count, ec_error *err);
    ec_result (*end)(void *rows, ec_error *err);
    void (*abort)(void *rows); /* NULL is fine */
} ec_format;

enum { EC_FORMAT_PNG, EC_FORMAT_JPEG, EC_FORMAT_HDR, EC_FORMAT_AVIF, EC_FORMAT_JXL, EC_FORMAT_COUNT };
extern const ec_format ec_formats[EC_FORMAT_COUNT];

ec_result ec_jpeg_begin(void **rows, const char *path, const ec_raster *of, const ec_png_text *text, ec_error *err);
ec_result ec_jpeg_put(void *rows, const void *pixels, uint32_t count, ec_error *err);
ec_result ec_jpeg_end(void *rows, ec_error *err);
void ec_jpeg_abort(void *rows);

ec_result ec_hdr_begin(void **rows, const char *path, const ec_raster *of, const ec_png_text *text, ec_error *err);
ec_result ec_hdr_put(void *rows, const void *pixels, uint32_t count, ec_error *err);
ec_result ec_hdr_end(void *rows, ec_error *err);
void ec_hdr_abort(void *rows);

#endif
