/* Compresses the pixels of a PNG to a zlib stream, in strips of rows that are filtered and compressed in parallel. */
#ifndef EC_IMAGE_PNG_STRIPS_H
#define EC_IMAGE_PNG_STRIPS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct ec_png_strip {
    struct ec_deflate *deflate; /* owned */
    uint8_t *packed;            /* owned; raw deflate (RFC 1951) that ends on a byte boundary */
    size_t size, room;
    unsigned long adler;        /* of the filtered rows */
    bool is_packed;
} ec_png_strip;

/* Strips of as many rows as fill EC_PNG_STRIP_BYTES: the file does not depend on the number of threads. */
enum { EC_PNG_STRIP_BYTES = 1 << 18 };
typedef struct ec_png_strips {
    size_t row_bytes, pixel_bytes;
    uint32_t height, strip_rows;
    uint32_t done;          /* rows in strips that were handed out */
    uint32_t waiting;       /* rows in `rows` */
    uint8_t *rows;          /* owned; the row before the waiting ones, and room for a strip for each thread */
    ec_png_strip *strip;    /* owned; strip_count of them */
    uint32_t strip_count, packed;
    unsigned long adler;    /* of all filtered rows so far */
} ec_png_strips;

bool ec_png_strips_create(ec_png_strips *strips, uint32_t width, uint32_t height, uint32_t pixel_bytes); /* false: out of memory */
void ec_png_strips_free(ec_png_strips *strips);

/* Takes as many rows of pixels as there is room for, and returns their number. If strips are full then, or the picture is complete, the first
 * `packed` strips of strip[] hold the next part of the stream until the next call. */
uint32_t ec_png_strips_put(ec_png_strips *strips, const uint8_t *pixels, uint32_t count);

/* The bytes before the first strip, and after the last one. */
extern const uint8_t ec_png_stream_head[2];
void ec_png_stream_tail(const ec_png_strips *strips, uint8_t tail[4]);

#endif
