/* Pictures in and out. A file has its name only once it is whole: never half a picture. */
#ifndef EC_IMAGE_IMAGE_H
#define EC_IMAGE_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "film/channels.h"
#include "image/screen.h"
#include "image/srgb.h"

/* One EXR channel. */
typedef struct ec_channel {
    const char *name;     /* e.g. "R", "stderr.R", "depth.Z" */
    const float *data;    /* first value; pixel (x, y) is data[stride * (y * width + x)] */
    uint32_t stride;      /* in floats */
    ec_channel_type type; /* of the data, and in the file */
} ec_channel;

typedef enum ec_attribute_type { EC_ATTR_STRING, EC_ATTR_INT, EC_ATTR_DOUBLE } ec_attribute_type;
typedef struct ec_attribute {
    const char *name;   /* e.g. "eclat.seed" */
    ec_attribute_type type;
    const char *string;
    double number;
} ec_attribute;

/* Single-part scan-line EXR, ZIP compressed (channels in any order here; sorted in the file). */
ec_result ec_exr_write(const char *path, uint32_t width, uint32_t height, const ec_channel *channels,
                       uint32_t channel_count, const ec_attribute *attributes, uint32_t attribute_count, ec_error *err);

/* Writes several parts of one size, each with a name of its own. The first is what viewers show. The file is sealed: see seal.h. */
typedef struct ec_exr_part {
    const char *name;
    const ec_channel *channels;
    uint32_t channel_count;
    const ec_attribute *attributes;
    uint32_t attribute_count;
    bool is_plain;      /* not compressed: for what hardly gets smaller */
    bool is_sealed;     /* of the first part: the file is, though it has no other; see seal.h */
} ec_exr_part;
ec_result ec_exr_write_parts(const char *path, uint32_t width, uint32_t height, const ec_exr_part *parts,
                             uint32_t part_count, ec_error *err);

/* Writes rows that come one after the other, from the top; path and parts stay as they are until the end. room: bytes by which the attributes
 * of the end may be longer or shorter than those of the beginning, by blanks in an attribute eclat.room; 0: they are as long. */
typedef struct ec_exr_rows ec_exr_rows;
enum { EC_EXR_ROWS = 16 }; /* that are compressed together */
ec_result ec_exr_rows_begin(ec_exr_rows **rows, const char *path, uint32_t width, uint32_t height, const ec_exr_part *parts,
                            uint32_t part_count, uint32_t room, ec_error *err);
/* The next rows, a multiple of EC_EXR_ROWS or up to the last, of parts[0], after its last row of parts[1], and so on: `part` has the same
 * channels, whose data begin with these rows. */
ec_result ec_exr_rows_put(ec_exr_rows *rows, const ec_exr_part *part, uint32_t count, ec_error *err);
/* The file gets its name; after a failure there is none. attributes: what the first part's have become; NULL: nothing else. Frees rows. */
ec_result ec_exr_rows_end(ec_exr_rows *rows, const ec_attribute *attributes, uint32_t attribute_count, ec_error *err);
void ec_exr_rows_abort(ec_exr_rows *rows); /* leaves nothing; frees rows; NULL is fine */

/* Where a channel's values are wanted: pixel (x, y) at data[stride * (y * width + x)], in 32-bit values. */
typedef struct ec_exr_room {
    const char *name;
    void *data;
    uint32_t stride;
} ec_exr_room;

/* All channels of an EXR file's first part as float planes, half and uint converted. Tiled (first level) and scan-line,
 * every compression; of DWAA and DWAB files only R, G, B and A. Deep and subsampled images are refused. */
typedef struct ec_exr {
    uint32_t width, height, channel_count;
    char **names;       /* owned, as in the file */
    float **planes;     /* owned, width * height each */
} ec_exr;
ec_result ec_exr_read(const char *path, ec_exr *exr, ec_error *err);
/* Only these channels (NULL ends them; none: all): others are named, and their planes NULL. */
ec_result ec_exr_read_some(const char *path, const char *const *wanted, ec_exr *exr, ec_error *err);
const float *ec_exr_plane(const ec_exr *exr, const char *name); /* NULL if absent */
void ec_exr_free(ec_exr *exr);

/* Equirectangular map, .hdr or .exr by content, to 3 floats a pixel (malloc'ed, caller frees). As in the file: nothing
 * is clamped here. */
ec_result ec_image_read_rgb(const char *path, uint32_t *width, uint32_t *height, float **rgb, ec_error *err);

/* ec_screen_pixels before the environment. in: 3 floats a pixel; out: 3 bytes a pixel. */
void ec_tonemap_rgb(const float *in, uint8_t *out, uint64_t pixel_count, float exposure_ev, ec_tonemap tonemap);

/* Maps one pixel, multiplied by `scale`, in place: sRGB values from 0 to 1, not rounded. */
void ec_tonemap_pixel(double rgb[3], double scale, ec_tonemap tonemap);

ec_result ec_png_write(const char *path, uint32_t width, uint32_t height, const uint8_t *rgb, ec_error *err);

/* Kept in a file beside the picture; viewers leave it alone. UTF-8; keyword: up to 79 characters. */
typedef struct ec_png_text {
    const char *keyword, *text; /* NULL: none */
} ec_png_text;

/* Writes rows that come one after the other, from the top; path stays until the end. text: NULL is none. */
typedef struct ec_png_rows ec_png_rows;
ec_result ec_png_rows_begin(ec_png_rows **rows, const char *path, const ec_raster *of, const ec_png_text *text, ec_error *err);
ec_result ec_png_rows_put(ec_png_rows *rows, const uint8_t *pixels, uint32_t count, ec_error *err);
ec_result ec_png_rows_end(ec_png_rows *rows, ec_error *err); /* the file gets its name; after a failure there is none. Frees rows */
void ec_png_rows_abort(ec_png_rows *rows);                   /* leaves nothing; frees rows; NULL is fine */

/* What a PNG keeps under that keyword before its picture, malloc'ed; NULL where there is none. */
char *ec_png_text_of(const char *path, const char *keyword, bool *is_whole);

/* In memory; *bytes is malloc'ed. */
ec_result ec_png_encode(uint32_t width, uint32_t height, const uint8_t *rgb, uint8_t **bytes, size_t *size, ec_error *err);

/* Before a file is opened for reading: a pipe could block for ever, a device have no end. What is not there passes. */
ec_result ec_image_check_regular(const char *path, ec_error *err);

/* Before a long render: can this file be written here? Leaves nothing behind. */
ec_result ec_image_check_writable(const char *path, ec_error *err);

#endif
