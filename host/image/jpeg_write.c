/* Writes JPEG with libjpeg: quality 95, full-resolution colours. Compresses in memory, so that a full disk shows once, at the end. */
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>

#include <jpeglib.h>

#include "base/atomic_file.h"
#include "image/formats.h"

enum { QUALITY = 95 };

typedef struct jpeg_rows {
    ec_atomic_file file;
    const char *path; /* the caller's */
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    jmp_buf escape;
    unsigned char *bytes; /* libjpeg's, malloc'ed */
    unsigned long size;
    char message[JMSG_LENGTH_MAX];
} jpeg_rows;

static void complain(j_common_ptr common)
{
    jpeg_rows *r = common->client_data;
    common->err->format_message(common, r->message);
    longjmp(r->escape, 1);
}

static ec_result failed(const jpeg_rows *r, ec_error *err) { return ec_fail(err, "cannot write '%s': %s", r->path, r->message); }

static ec_result begin(jpeg_rows *r, const ec_raster *of, ec_error *err)
{
    EC_TRY(ec_atomic_open(&r->file, r->path, err));
    r->jpeg.err = jpeg_std_error(&r->errors);
    r->errors.error_exit = complain;
    r->jpeg.client_data = r;
    if (setjmp(r->escape)) return failed(r, err);
    jpeg_create_compress(&r->jpeg);
    jpeg_mem_dest(&r->jpeg, &r->bytes, &r->size);
    r->jpeg.image_width = of->width;
    r->jpeg.image_height = of->height;
    r->jpeg.input_components = 3;
    r->jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&r->jpeg);
    jpeg_set_quality(&r->jpeg, QUALITY, TRUE);
    r->jpeg.comp_info[0].h_samp_factor = r->jpeg.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&r->jpeg, TRUE);
    return EC_OK;
}

ec_result ec_jpeg_begin(void **made, const char *path, const ec_raster *of, const ec_png_text *text, ec_error *err)
{
    jpeg_rows *r = calloc(1, sizeof *r);
    (void)text;
    *made = NULL;
    if (!r) return ec_fail(err, "out of memory for '%s'", path);
    r->file.fd = -1;
    r->path = path;
    if (begin(r, of, err) != EC_OK) {
        ec_jpeg_abort(r);
        return EC_FAILED;
    }
    *made = r;
    return EC_OK;
}

ec_result ec_jpeg_put(void *rows, const void *pixels, uint32_t count, ec_error *err)
{
    jpeg_rows *r = rows;
    if (setjmp(r->escape)) return failed(r, err);
    for (uint32_t y = 0; y < count; y++) {
        JSAMPROW row = (JSAMPROW)(uintptr_t)pixels + (size_t)3 * r->jpeg.image_width * y;
        jpeg_write_scanlines(&r->jpeg, &row, 1);
    }
    return EC_OK;
}

static ec_result finish(jpeg_rows *r, ec_error *err)
{
    if (setjmp(r->escape)) return failed(r, err);
    jpeg_finish_compress(&r->jpeg);
    EC_TRY(ec_atomic_append(&r->file, r->bytes, r->size, err));
    return ec_atomic_commit(&r->file, err);
}

ec_result ec_jpeg_end(void *rows, ec_error *err)
{
    const ec_result result = finish(rows, err);
    ec_jpeg_abort(rows);
    return result;
}

void ec_jpeg_abort(void *rows)
{
    jpeg_rows *r = rows;
    if (!r) return;
    if (r->jpeg.err) jpeg_destroy_compress(&r->jpeg);
    ec_atomic_abort(&r->file);
    free(r->bytes);
    free(r);
}
