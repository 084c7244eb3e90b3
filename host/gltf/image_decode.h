/* Decodes images: those of textures, and pictures to compare. */
#ifndef EC_GLTF_IMAGE_DECODE_H
#define EC_GLTF_IMAGE_DECODE_H

#include "scene/scene.h"

typedef struct ec_decode_error {
    char text[160];     /* why it failed, without control characters; after success: how the data are damaged, or "" */
    bool out_of_memory; /* the picture itself may be intact */
} ec_decode_error;

/* Decodes PNG and JPEG, and WebP, AVIF and KTX2 if the build has them, recognised by content. Sets size and pixels of *image, which must be zero
 * before; an image whose size ec_image_size gives may have that size already, and room for its pixels in rgba8. */
bool ec_image_decode(const uint8_t *bytes, uint64_t length, ec_image *image, ec_decode_error *err);

/* Reads the size from the header of a JPEG, or of a PNG whose pixels become rgba8. Returns false for anything else, or if the header is damaged. */
bool ec_image_size(const uint8_t *bytes, uint64_t length, uint32_t *width, uint32_t *height);
bool ec_image_size_png(const uint8_t *bytes, size_t length, uint32_t *width, uint32_t *height);
bool ec_image_size_jpeg(const uint8_t *bytes, size_t length, uint32_t *width, uint32_t *height);

/* image_png.c, image_jpeg.c: decode one format each. They call ec_image_check_size before allocating pixels. */
bool ec_image_decode_png(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err);
bool ec_image_decode_jpeg(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err);

/* Checks the size by itself and against the number of encoded bytes. Returns NULL, or the reason why it is refused. */
const char *ec_image_check_size(uint64_t width, uint64_t height, size_t length, uint64_t pixels_per_byte);

/* Store the reason in err, control characters replaced. Return false. */
bool ec_decode_fail(ec_decode_error *err, const char *reason);
bool ec_decode_out_of_memory(ec_decode_error *err);

#endif
