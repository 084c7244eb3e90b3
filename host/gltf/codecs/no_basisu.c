/* Stands in for Basis Universal's transcoder in builds without it. */
#include "gltf/codecs.h"

const bool ec_has_basisu = false;

bool ec_image_decode_ktx2(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err)
{
    (void)bytes, (void)length, (void)image;
    return ec_decode_fail(err, "it is KTX2, which this eclat was built without (cmake -DBASISU_SOURCE=FOLDER); convert it to PNG, JPEG or WebP");
}
