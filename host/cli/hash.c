#include "cli/hash.h"

#include <stdio.h>
#include <string.h>
#include <sys/types.h>

#include <sha2.h>

enum { FLOATS_AT_ONCE = 1024 };

static void put_little_endian(const float *from, size_t count, uint8_t *to)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &from[i], 4);
        for (int k = 0; k < 4; k++) to[4 * i + (size_t)k] = (uint8_t)(bits >> (8 * k));
    }
}

void ec_hash_rgb(const float *rgb, uint64_t pixel_count, char text[EC_HASH_SIZE])
{
    SHA2_CTX context;
    uint8_t bytes[4 * FLOATS_AT_ONCE], digest[SHA256_DIGEST_LENGTH];
    SHA256Init(&context);
    for (uint64_t done = 0, all = 3 * pixel_count; done < all;) {
        size_t count = all - done < FLOATS_AT_ONCE ? (size_t)(all - done) : FLOATS_AT_ONCE;
        put_little_endian(rgb + done, count, bytes);
        SHA256Update(&context, bytes, 4 * count);
        done += count;
    }
    SHA256Final(digest, &context);
    for (int i = 0; i < SHA256_DIGEST_LENGTH; i++) snprintf(text + 2 * i, 3, "%02x", digest[i]);
}
