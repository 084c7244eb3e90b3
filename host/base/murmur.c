#include "base/murmur.h"

static uint32_t turn(uint32_t x, int by) { return x << by | x >> (32 - by); }

static uint32_t mixed(uint32_t block) { return turn(block * 0xcc9e2d51u, 15) * 0x1b873593u; }

/* Reads little-endian on any machine. */
static uint32_t block_at(const uint8_t *from, size_t size)
{
    uint32_t block = 0;
    for (size_t k = 0; k < size; k++) block |= (uint32_t)from[k] << 8 * k;
    return block;
}

uint32_t ec_murmur3(const void *bytes, size_t size, uint32_t seed)
{
    const uint8_t *from = bytes;
    uint32_t h = seed;
    for (size_t i = 0; i + 4 <= size; i += 4) h = turn(h ^ mixed(block_at(from + i, 4)), 13) * 5 + 0xe6546b64u;
    h ^= mixed(block_at(from + size / 4 * 4, size % 4)) ^ (uint32_t)size;
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return h ^ h >> 16;
}
