/* Limits and errors shared by all decoders. */
#include "gltf/image_decode.h"

#include <stdio.h>

#define MAX_SIDE 16384

bool ec_decode_fail(ec_decode_error *err, const char *reason)
{
    snprintf(err->text, sizeof err->text, "%s", reason);
    for (char *c = err->text; *c; c++)
        if ((unsigned char)*c < 32 || *c == 127) *c = '?';
    err->out_of_memory = false;
    return false;
}

bool ec_decode_out_of_memory(ec_decode_error *err)
{
    ec_decode_fail(err, "out of memory");
    err->out_of_memory = true;
    return false;
}

const char *ec_image_check_size(uint64_t width, uint64_t height, size_t length, uint64_t pixels_per_byte)
{
    if (!width || !height) return "it has no pixels";
    if (width > MAX_SIDE || height > MAX_SIDE) return "a side is longer than 16384 pixels";
    if (width * height / pixels_per_byte > length) return "its header claims more pixels than its bytes can hold";
    return NULL;
}
