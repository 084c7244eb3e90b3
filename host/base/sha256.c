#include "base/sha256.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <nettle/version.h>

#include "base/freed.h"

enum { AT_ONCE = 1 << 20 };

void ec_sha256_begin(ec_sha256 *hash) { sha256_init(&hash->context); }

void ec_sha256_add(ec_sha256 *hash, const void *bytes, size_t count)
{
    if (count) sha256_update(&hash->context, count, bytes);
}

void ec_sha256_end(ec_sha256 *hash, uint8_t digest[EC_SHA256_BYTES])
{
#if NETTLE_VERSION_MAJOR < 4
    sha256_digest(&hash->context, EC_SHA256_BYTES, digest);
#else
    sha256_digest(&hash->context, digest);
#endif
}

void ec_sha256_write(const uint8_t *digest, size_t count, char *text)
{
    for (size_t i = 0; i < count; i++) snprintf(text + 2 * i, 3, "%02x", digest[i]);
}

void ec_sha256_end_text(ec_sha256 *hash, char text[EC_SHA256_TEXT])
{
    uint8_t digest[EC_SHA256_BYTES];
    ec_sha256_end(hash, digest);
    ec_sha256_write(digest, sizeof digest, text);
}

int ec_sha256_add_file(ec_sha256 *hash, int fd, uint64_t size)
{
    EC_FREED uint8_t *bytes = malloc(AT_ONCE);
    if (!bytes) return ENOMEM;
    for (uint64_t done = 0; done < size;) {
        const ssize_t got = pread(fd, bytes, size - done < AT_ONCE ? (size_t)(size - done) : AT_ONCE, (off_t)done);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return got < 0 ? errno : EIO;
        ec_sha256_add(hash, bytes, (size_t)got);
        done += (uint64_t)got;
    }
    return 0;
}

bool ec_sha256_file(const char *path, char text[EC_SHA256_TEXT])
{
    ec_sha256 hash;
    struct stat known;
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0) return false;
    ec_sha256_begin(&hash);
    const bool is_whole = fstat(fd, &known) == 0 && ec_sha256_add_file(&hash, fd, (uint64_t)known.st_size) == 0;
    close(fd);
    if (is_whole) ec_sha256_end_text(&hash, text);
    return is_whole;
}
