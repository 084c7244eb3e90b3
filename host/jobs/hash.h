/* A fingerprint of the pixels, independent of dates and compression: it tells whether two renders gave the same bits. */
#ifndef EC_JOBS_HASH_H
#define EC_JOBS_HASH_H

#include <stdint.h>

#include "base/sha256.h"

enum { EC_HASH_SIZE = EC_SHA256_TEXT };

/* Hashes pixels piece by piece. */
typedef struct ec_hash {
    ec_sha256 sha256;
} ec_hash;
void ec_hash_begin(ec_hash *hash);
void ec_hash_add(ec_hash *hash, const float *rgb, uint64_t pixel_count);
void ec_hash_end(ec_hash *hash, char text[EC_HASH_SIZE]);

/* Writes the SHA-256 of 3 floats per pixel, as little-endian IEEE bytes, in hexadecimal. */
void ec_hash_rgb(const float *rgb, uint64_t pixel_count, char text[EC_HASH_SIZE]);

#endif
