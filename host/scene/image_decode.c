/* PNG and JPEG, glTF's two formats, through stb_image, whose other formats are left out: less to attack. */
#include "scene/flatten.h"

#include <limits.h>
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
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#include <stb_image.h>
#pragma GCC diagnostic pop

#define MAX_SIDE 16384
/* No PNG or JPEG packs more pixels into a byte; a header that claims more would cost a gigabyte for nothing. */
#define MAX_PIXELS_PER_BYTE 10000

bool ec_image_decode(const uint8_t *bytes, uint64_t length, ec_image *image, const char **reason)
{
    int width, height, channels;
    if (!length || length > INT_MAX) {
        *reason = "it is empty or larger than 2 GiB";
        return false;
    }
    if (!stbi_info_from_memory(bytes, (int)length, &width, &height, &channels)) {
        *reason = "it is neither PNG nor JPEG";
        return false;
    }
    if (width < 1 || height < 1 || width > MAX_SIDE || height > MAX_SIDE) {
        *reason = "a side is longer than 16384 pixels";
        return false;
    }
    if ((uint64_t)width * (uint64_t)height / MAX_PIXELS_PER_BYTE > length) {
        *reason = "its header claims more pixels than its bytes can hold";
        return false;
    }
    if (stbi_is_16_bit_from_memory(bytes, (int)length))
        image->rgba16 = stbi_load_16_from_memory(bytes, (int)length, &width, &height, &channels, 4);
    else
        image->rgba8 = stbi_load_from_memory(bytes, (int)length, &width, &height, &channels, 4);
    if (!image->rgba8 && !image->rgba16) {
        *reason = stbi_failure_reason();
        return false;
    }
    image->width = (uint32_t)width;
    image->height = (uint32_t)height;
    return true;
}
