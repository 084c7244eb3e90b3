/* Reads and writes pictures. A file gets its name only once it is complete: there is never half a picture. */
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
    uint32_t stride;      /* floats */
    ec_channel_type type; /* how the file stores the data: see film/channels.h */
} ec_channel;

typedef enum ec_attribute_type { EC_ATTR_STRING, EC_ATTR_INT, EC_ATTR_DOUBLE } ec_attribute_type;
typedef struct ec_attribute {
    const char *name;   /* e.g. "eclat.seed" */
    ec_attribute_type type;
    const char *string;
    double number;
} ec_attribute;

/* Writes a single-part scan-line EXR, ZIP compressed. Channels may be in any order; they are sorted in the file. */
ec_result ec_exr_write(const char *path, uint32_t width, uint32_t height, const ec_channel *channels,
                       uint32_t channel_count, const ec_attribute *attributes, uint32_t attribute_count, ec_error *err);

/* Writes several parts of one size, each with its own name. Viewers show the first. The file is sealed: see seal.h. */
typedef struct ec_exr_part {
    const char *name;
    const ec_channel *channels;
    uint32_t channel_count;
    const ec_attribute *attributes;
    uint32_t attribute_count;
    bool is_plain;      /* not compressed, for data that hardly get smaller */
    bool is_sealed;     /* set in the first part: seals a file without further parts; see seal.h */
} ec_exr_part;
ec_result ec_exr_write_parts(const char *path, uint32_t width, uint32_t height, const ec_exr_part *parts,
                             uint32_t part_count, ec_error *err);

/* Writes rows one after the other from the top; path and parts must not change until the end. room: bytes by which the final attributes may be longer
 * or shorter than the first ones, kept as blanks in an attribute eclat.room; 0: they have the same length. */
typedef struct ec_exr_rows ec_exr_rows;
enum { EC_EXR_ROWS = 16 }; /* rows that are compressed together */
ec_result ec_exr_rows_begin(ec_exr_rows **rows, const char *path, uint32_t width, uint32_t height, const ec_exr_part *parts,
                            uint32_t part_count, uint32_t room, ec_error *err);
/* Writes the next rows, a multiple of EC_EXR_ROWS or up to the last: of parts[0], then, after its last row, of parts[1] and so on. `part` has the
 * same channels, with data that begin with these rows. */
ec_result ec_exr_rows_put(ec_exr_rows *rows, const ec_exr_part *part, uint32_t count, ec_error *err);
/* Gives the file its name; after a failure there is no file. attributes: the final ones of the first part; NULL: unchanged. Frees rows. */
ec_result ec_exr_rows_end(ec_exr_rows *rows, const ec_attribute *attributes, uint32_t attribute_count, ec_error *err);
void ec_exr_rows_abort(ec_exr_rows *rows); /* leaves no file; frees rows; NULL is fine */

/* Memory for a channel's values: pixel (x, y) at data[stride * (y * width + x)], 32 bits each. */
typedef struct ec_exr_room {
    const char *name;
    void *data;
    uint32_t stride;
} ec_exr_room;

/* Reads all channels of an EXR file's first part as float planes, converting half and uint. Accepts tiles (first level) and scan lines, and every
 * compression; of DWAA and DWAB files only R, G, B and A. Refuses deep and subsampled images. */
typedef struct ec_exr {
    uint32_t width, height, channel_count;
    char **names;       /* owned, as in the file */
    float **planes;     /* owned, width * height each */
} ec_exr;
ec_result ec_exr_read(const char *path, ec_exr *exr, ec_error *err);
/* Reads only these channels (ended by NULL; none: all); others have names, but NULL planes. */
ec_result ec_exr_read_some(const char *path, const char *const *wanted, ec_exr *exr, ec_error *err);
const float *ec_exr_plane(const ec_exr *exr, const char *name); /* NULL if absent */
void ec_exr_free(ec_exr *exr);

/* Reads an equirectangular map, .hdr or .exr by content, to 3 floats per pixel, malloc'ed. Values are those of the file, not clamped. */
ec_result ec_image_read_rgb(const char *path, uint32_t *width, uint32_t *height, float **rgb, ec_error *err);

/* ec_screen_pixels in front of the environment. in: 3 floats per pixel; out: 3 bytes per pixel. */
void ec_tonemap_rgb(const float *in, uint8_t *out, uint64_t pixel_count, float exposure_ev, ec_tonemap tonemap);

/* Maps one pixel, multiplied by `scale`, in place to sRGB values from 0 to 1, not rounded. */
void ec_tonemap_pixel(double rgb[3], double scale, ec_tonemap tonemap);

ec_result ec_png_write(const char *path, uint32_t width, uint32_t height, const uint8_t *rgb, ec_error *err);

/* A text stored in a file beside the picture, which viewers ignore. UTF-8; keyword: up to 79 characters. */
typedef struct ec_png_text {
    const char *keyword, *text; /* NULL: none */
} ec_png_text;

/* Writes rows one after the other from the top; path must last until the end. text may be NULL. */
typedef struct ec_png_rows ec_png_rows;
ec_result ec_png_rows_begin(ec_png_rows **rows, const char *path, const ec_raster *of, const ec_png_text *text, ec_error *err);
ec_result ec_png_rows_put(ec_png_rows *rows, const uint8_t *pixels, uint32_t count, ec_error *err);
ec_result ec_png_rows_end(ec_png_rows *rows, ec_error *err); /* gives the file its name; after a failure there is no file. Frees rows */
void ec_png_rows_abort(ec_png_rows *rows);                   /* leaves no file; frees rows; NULL is fine */

/* Returns the text under a keyword before the pixels of a PNG, malloc'ed; NULL if there is none. *is_whole: the file is undamaged. */
char *ec_png_text_of(const char *path, const char *keyword, bool *is_whole);

/* Encodes in memory; *bytes is malloc'ed. */
ec_result ec_png_encode(uint32_t width, uint32_t height, const uint8_t *rgb, uint8_t **bytes, size_t *size, ec_error *err);

/* Checks that a file is regular before it is opened for reading: a pipe could block for ever, a device have no end. Files that do not exist pass. */
ec_result ec_image_check_regular(const char *path, ec_error *err);

/* Checks before a long render that this file can be written. Leaves nothing behind. */
ec_result ec_image_check_writable(const char *path, ec_error *err);

#endif
