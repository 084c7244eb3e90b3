/* Stands in for libavif, which is used only if cmake is given -DECLAT_AVIF=ON. */
#include "gltf/codecs.h"

const bool ec_has_avif = false;

bool ec_image_decode_avif(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err)
{
    (void)bytes, (void)length, (void)image;
    return ec_decode_fail(err, "it is AVIF, which this eclat was built without (libavif-dev)");
}
