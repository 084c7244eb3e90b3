#include "jobs/hash.h"

#include <string.h>

enum { FLOATS_AT_ONCE = 1024 };

static void put_little_endian(const float *from, size_t count, uint8_t *to)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &from[i], 4);
        for (int k = 0; k < 4; k++) to[4 * i + (size_t)k] = (uint8_t)(bits >> (8 * k));
    }
}

void ec_hash_begin(ec_hash *hash) { ec_sha256_begin(&hash->sha256); }

void ec_hash_add(ec_hash *hash, const float *rgb, uint64_t pixel_count)
{
    uint8_t bytes[4 * FLOATS_AT_ONCE];
    for (uint64_t done = 0, all = 3 * pixel_count; done < all;) {
        size_t count = all - done < FLOATS_AT_ONCE ? (size_t)(all - done) : FLOATS_AT_ONCE;
        put_little_endian(rgb + done, count, bytes);
        ec_sha256_add(&hash->sha256, bytes, 4 * count);
        done += count;
    }
}

void ec_hash_end(ec_hash *hash, char text[EC_HASH_SIZE]) { ec_sha256_end_text(&hash->sha256, text); }

void ec_hash_rgb(const float *rgb, uint64_t pixel_count, char text[EC_HASH_SIZE])
{
    ec_hash hash;
    ec_hash_begin(&hash);
    ec_hash_add(&hash, rgb, pixel_count);
    ec_hash_end(&hash, text);
}
