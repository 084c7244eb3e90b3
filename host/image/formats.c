#include "image/formats.h"

static ec_result png_begin(void **rows, const char *path, const ec_raster *of, const ec_png_text *text, ec_error *err)
{
    ec_png_rows *png;
    const ec_result result = ec_png_rows_begin(&png, path, of, text, err);
    *rows = png;
    return result;
}

static ec_result png_put(void *rows, const void *pixels, uint32_t count, ec_error *err) { return ec_png_rows_put(rows, pixels, count, err); }
static ec_result png_end(void *rows, ec_error *err) { return ec_png_rows_end(rows, err); }
static void png_abort(void *rows) { ec_png_rows_abort(rows); }

#define BEGIN(name) \
    static ec_result name##_begin(void **rows, const char *path, const ec_raster *of, const ec_png_text *text, ec_error *err) \
    { \
        (void)text; \
        return ec_gather_begin(ec_encode_##name, rows, path, of, err); \
    }
BEGIN(avif)
BEGIN(jxl)
#define GATHERED(name) \
    .has_alpha = true, .encode = &ec_encode_##name, .library = "lib" #name, .begin = name##_begin, .put = ec_gather_put, .end = ec_gather_end, .abort = ec_gather_abort

const ec_format ec_formats[EC_FORMAT_COUNT] = {
    [EC_FORMAT_PNG] = {{".png"}, .has_alpha = true, .has_16_bits = true, .keeps_text = true, .begin = png_begin, .put = png_put, .end = png_end, .abort = png_abort},
    [EC_FORMAT_JPEG] = {{".jpg", ".jpeg"}, .begin = ec_jpeg_begin, .put = ec_jpeg_put, .end = ec_jpeg_end, .abort = ec_jpeg_abort},
    [EC_FORMAT_HDR] = {{".hdr"}, .is_linear = true, .begin = ec_hdr_begin, .put = ec_hdr_put, .end = ec_hdr_end, .abort = ec_hdr_abort},
    [EC_FORMAT_AVIF] = {{".avif"}, GATHERED(avif)},
    [EC_FORMAT_JXL] = {{".jxl"}, .has_16_bits = true, GATHERED(jxl)},
};
