/* PNG out: 8-bit sRGB through libpng's simplified API, which also writes the sRGB chunk. */
#include <png.h>
#include <stdlib.h>

#include "image/atomic_file.h"
#include "image/image.h"
#include "image/png_text.h"

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

ec_result ec_png_write_text(const char *path, uint32_t width, uint32_t height, const uint8_t *rgb, const char *keyword, const char *text,
                            ec_error *err)
{
    uint8_t *bytes;
    size_t size;
    if (width == 0 || height == 0)
        return ec_fail(err, "cannot write '%s': an image of %u x %u pixels is empty", path, width, height);
    EC_TRY(ec_png_encode(width, height, rgb, &bytes, &size, err));
    ec_result result = text ? ec_png_add_text(&bytes, &size, keyword, text, err) : EC_OK;
    if (result == EC_OK) result = ec_atomic_write(path, bytes, size, err);
    free(bytes);
    return result;
}

ec_result ec_png_write(const char *path, uint32_t width, uint32_t height, const uint8_t *rgb, ec_error *err)
{
    return ec_png_write_text(path, width, height, rgb, NULL, NULL, err);
}
