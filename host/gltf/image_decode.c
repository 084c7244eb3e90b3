/* Recognises the format of an image, and calls its decoder. */
#include "gltf/codecs.h"

#include <string.h>

static const uint8_t png[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}, jpeg[3] = {0xff, 0xd8, 0xff};

bool ec_image_size(const uint8_t *bytes, uint64_t length, uint32_t *width, uint32_t *height)
{
    if (length > INT32_MAX) return false;
    if (length >= sizeof png && !memcmp(bytes, png, sizeof png)) return ec_image_size_png(bytes, (size_t)length, width, height);
    return length >= sizeof jpeg && !memcmp(bytes, jpeg, sizeof jpeg) && ec_image_size_jpeg(bytes, (size_t)length, width, height);
}

bool ec_image_decode(const uint8_t *bytes, uint64_t length, ec_image *image, ec_decode_error *err)
{
    static const uint8_t ktx2[12] = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
    if (length > INT32_MAX) return ec_decode_fail(err, "it is larger than 2 GiB");
    if (length >= sizeof png && !memcmp(bytes, png, sizeof png))
        return ec_image_decode_png(bytes, (size_t)length, image, err);
    if (length >= sizeof jpeg && !memcmp(bytes, jpeg, sizeof jpeg))
        return ec_image_decode_jpeg(bytes, (size_t)length, image, err);
    if (length >= 12 && !memcmp(bytes, "RIFF", 4) && !memcmp(bytes + 8, "WEBP", 4))
        return ec_image_decode_webp(bytes, (size_t)length, image, err);
    if (length >= 12 && !memcmp(bytes + 4, "ftyp", 4)) return ec_image_decode_avif(bytes, (size_t)length, image, err);
    if (length >= sizeof ktx2 && !memcmp(bytes, ktx2, sizeof ktx2))
        return ec_image_decode_ktx2(bytes, (size_t)length, image, err);
    return ec_decode_fail(err, "it is not a PNG, JPEG, WebP, AVIF or KTX2");
}
