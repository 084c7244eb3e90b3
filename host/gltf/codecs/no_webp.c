/* Stands in for libwebp in builds without it. */
#include "gltf/codecs.h"

const bool ec_has_webp = false;

bool ec_image_decode_webp(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err)
{
    (void)bytes, (void)length, (void)image;
    return ec_decode_fail(err, "it is WebP, which this eclat was built without (libwebp-dev)");
}
