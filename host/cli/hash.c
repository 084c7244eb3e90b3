#include "cli/hash.h"

#include <stdio.h>
#include <string.h>
#include <sys/types.h>

#include <sha2.h>

void ec_hash_rgb(const float *rgb, uint64_t pixel_count, char text[EC_HASH_SIZE])
{
    SHA2_CTX context;
    uint8_t digest[SHA256_DIGEST_LENGTH];
    SHA256Init(&context);
    for (uint64_t i = 0; i < 3 * pixel_count; i++) {
        uint32_t bits;
        memcpy(&bits, &rgb[i], 4);
        const uint8_t bytes[4] = {(uint8_t)bits, (uint8_t)(bits >> 8), (uint8_t)(bits >> 16), (uint8_t)(bits >> 24)};
        SHA256Update(&context, bytes, sizeof bytes);
    }
    SHA256Final(digest, &context);
    for (int i = 0; i < SHA256_DIGEST_LENGTH; i++) snprintf(text + 2 * i, 3, "%02x", digest[i]);
}
