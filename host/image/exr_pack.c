#include "image/exr_pack.h"

#include <math.h>
#include <string.h>

static const uint32_t half_inf = 0x7c00, half_nan = 0x7e00, half_most = 0x7bff;

uint32_t ec_channel_bytes(ec_channel_type type) { return type == EC_CHANNEL_HALF ? 2 : 4; }

/* Converts IEEE 754 binary32 to binary16, to nearest, ties to even. Uses selections instead of branches, so that compilers vectorise it. */
static uint16_t half_of(float value)
{
    uint32_t bits, tiny;
    memcpy(&bits, &value, sizeof bits);
    const uint32_t sign = bits >> 16 & 0x8000, size = bits & 0x7fffffff;
    const float shifted = fabsf(value) + 0.5f; /* its last place is the least half, 2^-24 */
    memcpy(&tiny, &shifted, sizeof tiny);
    tiny -= 0x3f000000;
    tiny = tiny == 0 && size > 0 ? 1 : tiny;
    uint32_t normal = (size + 0xfff + (size >> 13 & 1) - 0x38000000) >> 13;
    normal = normal > half_most ? half_most : normal;
    normal = size >= 0x7f800000 ? size > 0x7f800000 ? half_nan : half_inf : normal;
    return (uint16_t)(sign | (size < 0x38800000 ? tiny : normal));
}

static void put16(uint32_t word, uint8_t *to)
{
    to[0] = (uint8_t)word;
    to[1] = (uint8_t)(word >> 8);
}

static void put32(uint32_t word, uint8_t *to)
{
    put16(word, to);
    put16(word >> 16, to + 2);
}

void ec_exr_pack(const ec_channel *channel, uint64_t first, uint32_t count, uint8_t *to)
{
    const size_t stride = channel->stride;
    const float *from = channel->data + stride * first;
    switch (channel->type) {
    case EC_CHANNEL_HALF:
        for (size_t i = 0; i < count; i++) put16(half_of(from[i * stride]), to + 2 * i);
        break;
    case EC_CHANNEL_UINT:
        for (size_t i = 0; i < count; i++) put32((uint32_t)from[i * stride], to + 4 * i);
        break;
    default:
        for (size_t i = 0; i < count; i++) {
            uint32_t word;
            memcpy(&word, from + i * stride, sizeof word);
            put32(word, to + 4 * i);
        }
    }
}
