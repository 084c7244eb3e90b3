/* Decodes JPEG with libjpeg-turbo. */
#include "gltf/image_decode.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

/* An 8x8 block takes at least about two bits. */
#define PIXELS_PER_BYTE 2000
/* A progressive file may repeat scans of the whole picture without end. */
#define MAX_SCANS 200

typedef struct reader {
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    jmp_buf escape;
    ec_decode_error *err;
    uint8_t *place;  /* the caller's memory for the pixels; NULL: none */
    uint8_t *pixels; /* own memory for the pixels, if there is no place */
} reader;

static void fail(reader *r, const char *reason)
{
    ec_decode_fail(r->err, reason);
    longjmp(r->escape, 1);
}

static void on_error(j_common_ptr common)
{
    char text[JMSG_LENGTH_MAX];
    common->err->format_message(common, text);
    fail(common->client_data, text);
}

/* Ignores damage, which is shown as decoded, but keeps the first warning. */
static void on_message(j_common_ptr common, int level)
{
    char text[JMSG_LENGTH_MAX];
    if (level >= 0 || common->err->num_warnings++) return;
    common->err->format_message(common, text);
    ec_decode_fail(((reader *)common->client_data)->err, text);
}

static void on_progress(j_common_ptr common)
{
    reader *r = common->client_data;
    if (r->jpeg.input_scan_number > MAX_SCANS) fail(r, "it has too many scans");
}

/* Converts CMYK in place, as both have four channels. Adobe stores it inverted; the other kind hardly exists. */
static void cmyk_to_rgba(uint8_t *row, uint32_t width, bool inverted)
{
    for (uint32_t x = 0; x < width; x++, row += 4) {
        unsigned k = inverted ? row[3] : 255u - row[3];
        for (int c = 0; c < 3; c++) row[c] = (uint8_t)((inverted ? row[c] : 255u - row[c]) * k / 255u);
        row[3] = 255;
    }
}

/* Errors leave by longjmp: whatever must be freed is in *r. */
static void read_header(reader *r, const uint8_t *bytes, size_t length)
{
    jpeg_create_decompress(&r->jpeg);
    r->jpeg.progress = &r->progress;
    jpeg_mem_src(&r->jpeg, bytes, (unsigned long)length);
    jpeg_read_header(&r->jpeg, TRUE);
    const char *reason = ec_image_check_size(r->jpeg.image_width, r->jpeg.image_height, length, PIXELS_PER_BYTE);
    if (reason) fail(r, reason);
}

static void read_picture(reader *r, const ec_image *image)
{
    struct jpeg_decompress_struct *jpeg = &r->jpeg;
    bool cmyk = jpeg->jpeg_color_space == JCS_CMYK || jpeg->jpeg_color_space == JCS_YCCK;
    jpeg->out_color_space = cmyk ? JCS_CMYK : JCS_EXT_RGBA;
    jpeg_start_decompress(jpeg);
    if (image->rgba8 && image->width == jpeg->output_width && image->height == jpeg->output_height) r->place = image->rgba8;
    size_t row_size = 4 * (size_t)jpeg->output_width;
    if (!r->place) r->pixels = malloc(row_size * jpeg->output_height);
    if (jpeg->output_components != 4) fail(r, "it has an unexpected layout");
    uint8_t *pixels = r->place ? r->place : r->pixels;
    if (!pixels) {
        ec_decode_out_of_memory(r->err);
        longjmp(r->escape, 1);
    }
    while (jpeg->output_scanline < jpeg->output_height) {
        JSAMPROW row = pixels + jpeg->output_scanline * row_size;
        jpeg_read_scanlines(jpeg, &row, 1);
        if (cmyk) cmyk_to_rgba(row, jpeg->output_width, jpeg->saw_Adobe_marker);
    }
}

/* Allocates the reader on the heap, as locals may be lost by a longjmp. */
static reader *make_reader(ec_decode_error *err)
{
    reader *r = calloc(1, sizeof *r);
    if (!r) return NULL;
    r->err = err;
    r->jpeg.err = jpeg_std_error(&r->errors);
    r->jpeg.client_data = r;
    r->errors.error_exit = on_error;
    r->errors.emit_message = on_message;
    r->progress.progress_monitor = on_progress;
    return r;
}

static void free_reader(reader *r)
{
    jpeg_destroy_decompress(&r->jpeg);
    free(r->pixels);
    free(r);
}

bool ec_image_size_jpeg(const uint8_t *bytes, size_t length, uint32_t *width, uint32_t *height)
{
    ec_decode_error err;
    reader *r = make_reader(&err);
    if (!r) return false;
    *width = *height = 0;
    if (!setjmp(r->escape)) {
        read_header(r, bytes, length);
        *width = r->jpeg.image_width;
        *height = r->jpeg.image_height;
    }
    free_reader(r);
    return *width && *height;
}

bool ec_image_decode_jpeg(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err)
{
    reader *r = make_reader(err);
    volatile bool ok = false;
    if (!r) return ec_decode_out_of_memory(err);
    if (!setjmp(r->escape)) {
        read_header(r, bytes, length);
        read_picture(r, image);
        image->width = r->jpeg.output_width;
        image->height = r->jpeg.output_height;
        if (!r->place) image->rgba8 = r->pixels;
        r->pixels = NULL;
        ok = true;
    }
    free_reader(r);
    return ok;
}
