/* PNG out: 8-bit sRGB through libpng's simplified API, which also writes the sRGB chunk. */
#include <errno.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "image/atomic_file.h"
#include "image/image.h"

/* A second descriptor, because fclose() must not close the one that the atomic file still has to sync and rename. */
static FILE *open_stream(int fd)
{
    int copy = dup(fd);
    FILE *stream = copy >= 0 ? fdopen(copy, "wb") : NULL;
    if (!stream && copy >= 0) close(copy);
    return stream;
}

ec_result ec_png_write(const char *path, uint32_t width, uint32_t height, const uint8_t *rgb, ec_error *err)
{
    if (width == 0 || height == 0)
        return ec_fail(err, "cannot write '%s': an image of %u x %u pixels is empty", path, width, height);
    ec_atomic_file file;
    EC_TRY(ec_atomic_open(&file, path, err));

    FILE *stream = open_stream(file.fd);
    if (!stream) {
        int reason = errno;
        ec_atomic_abort(&file);
        return ec_write_failed(err, path, reason);
    }
    png_image image = {.version = PNG_IMAGE_VERSION, .width = width, .height = height, .format = PNG_FORMAT_RGB};
    errno = 0;
    int encoded = png_image_write_to_stdio(&image, stream, 0, rgb, 0, NULL);
    int reason = encoded ? 0 : errno; /* libpng itself only says "Write Error" */
    if (fclose(stream) != 0 && !reason) reason = errno;
    png_image_free(&image);
    if (encoded && !reason) return ec_atomic_commit(&file, err);

    ec_atomic_abort(&file);
    if (reason) return ec_write_failed(err, path, reason);
    return ec_fail(err, "cannot write '%s': %s", path, image.message);
}

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
