/* Encoded pixels to ec_image: of textures, and of pictures that are compared. */
#ifndef EC_GLTF_IMAGE_DECODE_H
#define EC_GLTF_IMAGE_DECODE_H

#include "scene/scene.h"

typedef struct ec_decode_error {
    char text[160];     /* why, without control characters; of a picture that was decoded: how it is damaged, or "" */
    bool out_of_memory; /* the picture may be whole */
} ec_decode_error;

/* PNG, JPEG, and WebP, AVIF and KTX2 where the build reads them, by content. Sets size and pixels of *image, which must be zero before; but for what
 * ec_image_size tells of, it may have that size, and rgba8 room for its pixels. */
bool ec_image_decode(const uint8_t *bytes, uint64_t length, ec_image *image, ec_decode_error *err);

/* The size of a JPEG, or of a PNG whose pixels become rgba8, by its header. False: the file is neither, or its header is damaged. */
bool ec_image_size(const uint8_t *bytes, uint64_t length, uint32_t *width, uint32_t *height);
bool ec_image_size_png(const uint8_t *bytes, size_t length, uint32_t *width, uint32_t *height);
bool ec_image_size_jpeg(const uint8_t *bytes, size_t length, uint32_t *width, uint32_t *height);

/* image_png.c, image_jpeg.c: one format each. Call ec_image_check_size before allocating pixels. */
bool ec_image_decode_png(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err);
bool ec_image_decode_jpeg(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err);

/* Is the size sane, also for this many encoded bytes? NULL: yes; otherwise why not. */
const char *ec_image_check_size(uint64_t width, uint64_t height, size_t length, uint64_t pixels_per_byte);

/* false, with the text in err, control characters replaced. */
bool ec_decode_fail(ec_decode_error *err, const char *reason);
bool ec_decode_out_of_memory(ec_decode_error *err);

#endif
