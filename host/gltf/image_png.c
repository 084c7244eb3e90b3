/* Decodes PNG with libpng. Gamma and colour profiles are ignored, as glTF demands. */
#include "gltf/image_decode.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>

/* Deflate compresses up to 1032:1, and a byte can hold eight pixels. */
#define PIXELS_PER_BYTE 10000

typedef struct reader {
    const uint8_t *bytes;
    size_t length, done;
    ec_decode_error *err;
    uint8_t *place;  /* the caller's memory for the pixels; NULL: none */
    uint8_t *pixels; /* own memory for the pixels, if there is no place */
    uint8_t **rows;
    bool is_whole;
} reader;

static void on_error(png_structp png, png_const_charp message)
{
    reader *r = png_get_error_ptr(png);
    ec_decode_fail(r->err, message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png, (void)message;
}

static void on_read(png_structp png, png_bytep out, size_t count)
{
    reader *r = png_get_io_ptr(png);
    if (count > r->length - r->done) png_error(png, "it is truncated");
    memcpy(out, r->bytes + r->done, count);
    r->done += count;
}

/* Converts any format to four channels of 8 bits or, if the file has 16, of 16 bits in native byte order. */
static void set_transforms(png_structp png, png_infop info, bool deep)
{
    png_set_expand(png);
    if (png_get_color_type(png, info) == PNG_COLOR_TYPE_GRAY || png_get_color_type(png, info) == PNG_COLOR_TYPE_GRAY_ALPHA)
        png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xffff, PNG_FILLER_AFTER);
    if (deep && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__) png_set_swap(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
}

/* Errors leave by longjmp: whatever must be freed is in *r. */
static void read_picture(png_structp png, png_infop info, reader *r, ec_image *image)
{
    png_read_info(png, info);
    uint32_t width = png_get_image_width(png, info), height = png_get_image_height(png, info);
    const char *reason = ec_image_check_size(width, height, r->length, PIXELS_PER_BYTE);
    if (reason) png_error(png, reason);
    bool deep = png_get_bit_depth(png, info) == 16;
    set_transforms(png, info, deep);
    size_t row_size = (size_t)width * (deep ? 8 : 4);
    if (png_get_rowbytes(png, info) != row_size) png_error(png, "it has an unexpected layout");
    if (image->rgba8 && !deep && image->width == width && image->height == height) r->place = image->rgba8;
    if (!r->place) r->pixels = malloc(row_size * height);
    r->rows = malloc(height * sizeof *r->rows);
    if ((!r->place && !r->pixels) || !r->rows) {
        ec_decode_out_of_memory(r->err);
        png_longjmp(png, 1);
    }
    for (uint32_t y = 0; y < height; y++) r->rows[y] = (r->place ? r->place : r->pixels) + y * row_size;
    png_read_image(png, r->rows);
    image->width = width;
    image->height = height;
    if (deep) image->rgba16 = (uint16_t *)(void *)r->pixels; /* malloc'ed, so aligned */
    else if (!r->place) image->rgba8 = r->pixels;
    r->pixels = NULL;
    r->is_whole = true;
}

static uint32_t big_endian(const uint8_t *b) { return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3]; }

bool ec_image_size_png(const uint8_t *bytes, size_t length, uint32_t *width, uint32_t *height)
{
    if (length < 25 || bytes[24] > 8) return false; /* the first chunk has the size, and the bits of a channel */
    *width = big_endian(bytes + 16);
    *height = big_endian(bytes + 20);
    return !ec_image_check_size(*width, *height, length, PIXELS_PER_BYTE);
}

bool ec_image_decode_png(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err)
{
    reader *r = calloc(1, sizeof *r); /* on the heap, as locals may be lost by a longjmp */
    if (!r) return ec_decode_out_of_memory(err);
    *r = (reader){.bytes = bytes, .length = length, .err = err};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, r, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    ec_decode_out_of_memory(err);
    if (info && !setjmp(png_jmpbuf(png))) {
        png_set_read_fn(png, r, on_read);
        png_set_chunk_malloc_max(png, 16 << 20);
        read_picture(png, info, r, image);
    }
    png_destroy_read_struct(&png, &info, NULL);
    const bool is_whole = r->is_whole;
    free(r->pixels);
    free(r->rows);
    free(r);
    if (!is_whole) return false;
    *err = (ec_decode_error){0};
    return true;
}
