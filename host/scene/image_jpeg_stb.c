/* JPEG through stb_image: only until the build links libjpeg (ECLAT_LIBJPEG); Debian's stb 2.27 is not fit for files
 * from strangers. This file can then go. */
#ifndef ECLAT_LIBJPEG
#include "scene/image_decode.h"

#include <stdlib.h>

/* To the end of the file: of what is left out, declarations remain. */
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wsign-compare"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#include <stb_image.h>
#pragma GCC diagnostic pop

/* Huffman tables of more than 256 codes run over stb 2.27's arrays. Anything that could be read as one is refused. */
static bool has_long_huffman_table(const uint8_t *bytes, size_t length)
{
    for (size_t i = 0; i + 4 < length; i++) {
        if (bytes[i] != 0xff || bytes[i + 1] != 0xc4) continue;
        size_t at = i + 4, end = at + (size_t)bytes[i + 2] * 256 + bytes[i + 3] - 2;
        while (at < end && at + 17 <= length) {
            unsigned codes = 0;
            for (int k = 1; k <= 16; k++) codes += bytes[at + (size_t)k];
            if (codes > 256) return true;
            at += 17 + codes;
        }
    }
    return false;
}

bool ec_image_decode_jpeg(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err)
{
    int width, height, channels;
    if (has_long_huffman_table(bytes, length)) return ec_decode_fail(err, "a Huffman table is broken");
    if (!stbi_info_from_memory(bytes, (int)length, &width, &height, &channels))
        return ec_decode_fail(err, stbi_failure_reason());
    const char *reason = ec_image_check_size((uint64_t)width, (uint64_t)height, length, 2000);
    if (reason) return ec_decode_fail(err, reason);
    image->rgba8 = stbi_load_from_memory(bytes, (int)length, &width, &height, &channels, 4);
    if (!image->rgba8) return ec_decode_fail(err, stbi_failure_reason());
    image->width = (uint32_t)width;
    image->height = (uint32_t)height;
    return true;
}
#else
typedef int ec_image_jpeg_stb_is_unused;
#endif
