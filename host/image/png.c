/* Writes PNG: sRGB, of 8 or 16 bits. In memory with libpng's simplified API; to files row by row, compressed by all threads (png_strips.h). Both
 * write the sRGB chunk. */
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/atomic_file.h"
#include "image/image.h"
#include "image/png_strips.h"

ec_result ec_png_encode(uint32_t width, uint32_t height, const uint8_t *rgb, uint8_t **bytes, size_t *size, ec_error *err)
{
    png_image image = {.version = PNG_IMAGE_VERSION, .width = width, .height = height, .format = PNG_FORMAT_RGB};
    png_alloc_size_t room = PNG_IMAGE_PNG_SIZE_MAX(image);
    *bytes = malloc(room);
    int encoded = *bytes && png_image_write_to_memory(&image, *bytes, &room, 0, rgb, 0, NULL);
    *size = room;
    png_image_free(&image);
    if (encoded) return EC_OK;
    free(*bytes);
    *bytes = NULL;
    return ec_fail(err, "cannot make a PNG of %u x %u pixels: %s", width, height, *image.message ? image.message : "out of memory");
}

struct ec_png_rows {
    ec_atomic_file file;
    const char *path;     /* the caller's */
    png_structp png;
    png_infop info;
    ec_png_strips strips;
    bool has_begun;       /* the head of the zlib stream is written */
    int write_error;      /* errno of the write that failed */
    char message[128];    /* the library's last message */
};

/* Keeps the message and leaves libpng by longjmp. */
static void complain(png_structp png, png_const_charp message)
{
    ec_png_rows *rows = png_get_error_ptr(png);
    snprintf(rows->message, sizeof rows->message, "%s", message);
    png_longjmp(png, 1);
}

static void warn(png_structp png, png_const_charp message)
{
    ec_png_rows *rows = png_get_error_ptr(png);
    snprintf(rows->message, sizeof rows->message, "%s", message); /* a warning tells the cause of the error that follows */
}

static void write_all(png_structp png, png_bytep bytes, size_t size)
{
    ec_png_rows *rows = png_get_io_ptr(png);
    rows->write_error = ec_write_all(rows->file.fd, bytes, size, -1);
    if (rows->write_error) png_error(png, "write");
}

static void flush(png_structp png) { (void)png; }

static ec_result failed(const ec_png_rows *rows, ec_error *err)
{
    if (rows->write_error) return ec_write_failed(err, rows->path, rows->write_error);
    return ec_fail(err, "cannot write '%s': %s", rows->path, *rows->message ? rows->message : "out of memory");
}

static void put_text(const ec_png_rows *rows, const ec_png_text *text)
{
    png_text one = {.compression = PNG_ITXT_COMPRESSION_NONE, .key = (png_charp)(uintptr_t)text->keyword, .text = (png_charp)(uintptr_t)text->text};
    if (text->text) png_set_text(rows->png, rows->info, &one, 1);
}

static ec_result begin(ec_png_rows *rows, const ec_raster *of, const ec_png_text *text, ec_error *err)
{
    if (of->width == 0 || of->height == 0)
        return ec_fail(err, "cannot write '%s': an image of %u x %u pixels is empty", rows->path, of->width, of->height);
    if (!ec_png_strips_create(&rows->strips, of->width, of->height, ec_raster_pixel_bytes(of))) return failed(rows, err);
    EC_TRY(ec_atomic_open(&rows->file, rows->path, err));
    rows->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, rows, complain, warn);
    rows->info = rows->png ? png_create_info_struct(rows->png) : NULL;
    if (!rows->info || setjmp(png_jmpbuf(rows->png))) return failed(rows, err);
    png_set_write_fn(rows->png, rows, write_all, flush);
    png_set_IHDR(rows->png, rows->info, of->width, of->height, (int)of->bits, of->channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(rows->png, rows->info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (text) put_text(rows, text);
    png_write_info(rows->png, rows->info);
    return EC_OK;
}

ec_result ec_png_rows_begin(ec_png_rows **made, const char *path, const ec_raster *of, const ec_png_text *text, ec_error *err)
{
    ec_png_rows *rows = calloc(1, sizeof *rows);
    *made = NULL;
    if (!rows) return ec_fail(err, "out of memory for '%s'", path);
    *rows = (ec_png_rows){.file.fd = -1, .path = path};
    if (begin(rows, of, text, err) != EC_OK) {
        ec_png_rows_abort(rows);
        return EC_FAILED;
    }
    *made = rows;
    return EC_OK;
}

/* Writes the finished strips, one chunk each; leaves by longjmp if that fails. */
static void put_strips(ec_png_rows *rows)
{
    const ec_png_strips *s = &rows->strips;
    static const png_byte name[5] = "IDAT";
    uint8_t tail[4];
    ec_png_stream_tail(s, tail);
    for (uint32_t k = 0; k < s->packed; k++) {
        const bool is_last = s->done == s->height && k == s->packed - 1;
        const size_t head = rows->has_begun ? 0 : sizeof ec_png_stream_head, end = is_last ? sizeof tail : 0;
        if (!s->strip[k].is_packed) png_error(rows->png, "out of memory");
        png_write_chunk_start(rows->png, name, (png_uint_32)(head + s->strip[k].size + end));
        png_write_chunk_data(rows->png, ec_png_stream_head, head);
        png_write_chunk_data(rows->png, s->strip[k].packed, s->strip[k].size);
        png_write_chunk_data(rows->png, tail, end);
        png_write_chunk_end(rows->png);
        rows->has_begun = true;
    }
}

ec_result ec_png_rows_put(ec_png_rows *rows, const uint8_t *pixels, uint32_t count, ec_error *err)
{
    if (setjmp(png_jmpbuf(rows->png))) return failed(rows, err);
    for (uint32_t y = 0; y < count;) {
        y += ec_png_strips_put(&rows->strips, pixels + (uint64_t)y * rows->strips.row_bytes, count - y);
        put_strips(rows);
    }
    return EC_OK;
}

static ec_result finish(ec_png_rows *rows, ec_error *err)
{
    if (setjmp(png_jmpbuf(rows->png))) return failed(rows, err);
    png_write_chunk(rows->png, (png_const_bytep)"IEND", NULL, 0); /* png_write_end accepts only libpng's own stream */
    return ec_atomic_commit(&rows->file, err);
}

ec_result ec_png_rows_end(ec_png_rows *rows, ec_error *err)
{
    ec_result result = finish(rows, err);
    ec_png_rows_abort(rows);
    return result;
}

void ec_png_rows_abort(ec_png_rows *rows)
{
    if (!rows) return;
    png_destroy_write_struct(&rows->png, &rows->info);
    ec_png_strips_free(&rows->strips);
    ec_atomic_abort(&rows->file);
    free(rows);
}

ec_result ec_png_write(const char *path, uint32_t width, uint32_t height, const uint8_t *rgb, ec_error *err)
{
    ec_png_rows *rows;
    EC_TRY(ec_png_rows_begin(&rows, path, &(ec_raster){width, height, 3, 8}, NULL, err));
    if (ec_png_rows_put(rows, rgb, height, err) == EC_OK) return ec_png_rows_end(rows, err);
    ec_png_rows_abort(rows);
    return EC_FAILED;
}
