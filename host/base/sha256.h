/* SHA-256 (FIPS 180-4) by Nettle, which uses the processor's instructions for it if there are some. */
#ifndef EC_BASE_SHA256_H
#define EC_BASE_SHA256_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <nettle/sha2.h>

enum { EC_SHA256_BYTES = 32, EC_SHA256_TEXT = 2 * EC_SHA256_BYTES + 1 };

typedef struct ec_sha256 {
    struct sha256_ctx context;
} ec_sha256;

void ec_sha256_begin(ec_sha256 *hash);
void ec_sha256_add(ec_sha256 *hash, const void *bytes, size_t count);
void ec_sha256_end(ec_sha256 *hash, uint8_t digest[EC_SHA256_BYTES]);

/* Writes the first `count` bytes of a digest in hexadecimal; text: room for 2 count + 1 characters. */
void ec_sha256_write(const uint8_t *digest, size_t count, char *text);

/* Ends the hash, and writes its digest in hexadecimal. */
void ec_sha256_end_text(ec_sha256 *hash, char text[EC_SHA256_TEXT]);

/* Adds the first `size` bytes of an open file. Returns 0 or an errno value, EIO if the file is shorter. */
int ec_sha256_add_file(ec_sha256 *hash, int fd, uint64_t size);

/* Writes the digest of a whole file; false: it cannot be read. */
bool ec_sha256_file(const char *path, char text[EC_SHA256_TEXT]);

#endif
