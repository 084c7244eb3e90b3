/* Decodes WebP with libwebp. */
#include <stdlib.h>
#include <webp/decode.h>

#include "gltf/codecs.h"

const bool ec_has_webp = true;

/* A lossless picture of one colour takes a few bytes, whatever its size: only the longest side limits it. */
#define PIXELS_PER_BYTE (1 << 24)

bool ec_image_decode_webp(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err)
{
    WebPBitstreamFeatures is;
    if (WebPGetFeatures(bytes, length, &is) != VP8_STATUS_OK) return ec_decode_fail(err, "its WebP header is broken");
    if (is.has_animation) return ec_decode_fail(err, "it is an animated WebP, which is not supported; save a single picture of it");
    const char *reason = ec_image_check_size((uint64_t)is.width, (uint64_t)is.height, length, PIXELS_PER_BYTE);
    if (reason) return ec_decode_fail(err, reason);
    size_t row = 4 * (size_t)is.width, size = row * (size_t)is.height;
    uint8_t *pixels = malloc(size);
    if (!pixels) return ec_decode_out_of_memory(err);
    if (!WebPDecodeRGBAInto(bytes, length, pixels, size, (int)row)) {
        free(pixels);
        return ec_decode_fail(err, "its WebP data are broken or truncated");
    }
    image->width = (uint32_t)is.width;
    image->height = (uint32_t)is.height;
    image->rgba8 = pixels;
    return true;
}
