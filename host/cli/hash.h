/* A fingerprint of the picture itself, free of dates and compression: two renders gave the same bits or they did not. */
#ifndef EC_CLI_HASH_H
#define EC_CLI_HASH_H

#include <stdint.h>

enum { EC_HASH_SIZE = 65 };

/* SHA-256 of 3 floats a pixel as little-endian IEEE bytes, in hexadecimal. */
void ec_hash_rgb(const float *rgb, uint64_t pixel_count, char text[EC_HASH_SIZE]);

#endif
