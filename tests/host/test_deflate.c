/* tier: quick */
/* Blocks decompress to the original, and compress to the same bytes each time, whatever is behind them in memory or was compressed before. */
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "image/deflate.h"
#include "support/test.h"

enum { MOST = 5000, ROOM = 2 * MOST };
static uint8_t block[MOST], from[MOST + EC_DEFLATE_PAST], first[ROOM], second[ROOM], back[MOST];
static uint32_t state = 1;

static uint32_t number(uint32_t below)
{
    state = state * 1664525 + 1013904223;
    return (uint32_t)((uint64_t)state * below >> 32);
}

/* Repeated runs, as in a picture. */
static size_t make_block(void)
{
    const size_t size = 1 + number(MOST);
    const uint32_t values = 2 + number(20);
    for (size_t i = 0; i < size; i++) block[i] = (uint8_t)(i > 40 && number(4) ? block[i - 1 - number(40)] : number(values));
    return size;
}

static size_t pack(ec_deflate *d, ec_deflate_kind kind, size_t size, uint8_t *to)
{
    memcpy(from, block, size);
    for (size_t i = size; i < sizeof from; i++) from[i] = (uint8_t)(number(2) ? block[i % size] : number(256));
    return ec_deflate_pack(d, kind, from, size, to, ROOM);
}

static void check_back(ec_deflate_kind kind, size_t size, size_t packed)
{
    z_stream z = {.next_in = first, .avail_in = (uInt)packed, .next_out = back, .avail_out = sizeof back};
    const int end = kind == EC_DEFLATE_PART ? Z_OK : Z_STREAM_END;
    CHECK(inflateInit2(&z, kind == EC_DEFLATE_ZLIB ? 15 : -15) == Z_OK);
    const int code = inflate(&z, Z_SYNC_FLUSH);
    CHECK_MSG(code == end && z.total_out == size && !memcmp(back, block, size), "%zu bytes, kind %d: zlib says %d after %lu", size, (int)kind, code, z.total_out);
    inflateEnd(&z);
}

int main(void)
{
    ec_deflate *d = ec_deflate_create(), *other = ec_deflate_create();
    uint32_t strays = 0;
    for (int i = 0; i < 3000 && d && other; i++) {
        const ec_deflate_kind kind = (ec_deflate_kind)(i % 3);
        const size_t size = make_block(), packed = pack(d, kind, size, first);
        CHECK(packed > 0 && packed <= ec_deflate_bound(size));
        check_back(kind, size, packed);
        strays += pack(other, kind, size, second) != packed || memcmp(first, second, packed) != 0;
        if (i % 7 == 0) pack(other, kind, 1 + number((uint32_t)size), second);
    }
    CHECK_MSG(strays == 0, "%u of 3000 blocks have other bytes the second time", strays);
    ec_deflate_free(d);
    ec_deflate_free(other);
    TEST_END();
}
