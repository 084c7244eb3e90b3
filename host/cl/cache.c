/* Entries of the kernel cache: FOLDER/<key>.bin = header, binary. */
#include "cl/cache.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/sha256.h"

#define EC_CACHE_MAGIC "eclatkb1"
#define EC_CACHE_LARGEST ((uint64_t)1 << 30)

typedef struct cache_header {
    char magic[8];
    uint8_t key[32];
    uint8_t checksum[32]; /* SHA-256 of the binary */
    uint64_t bytes;       /* of the binary */
} cache_header;

static void sha256(const unsigned char *data, size_t bytes, uint8_t digest[32])
{
    ec_sha256 hash;
    ec_sha256_begin(&hash);
    ec_sha256_add(&hash, data, bytes);
    ec_sha256_end(&hash, digest);
}

/* Adds a text with its length in front: otherwise moving a character from one text to the next would leave the key as it is. */
static void add_text(ec_sha256 *hash, const char *text)
{
    uint64_t length = strlen(text);
    ec_sha256_add(hash, &length, sizeof length);
    ec_sha256_add(hash, text, length);
}

ec_cache_key ec_cache_key_of(const ec_device_info *device, const char *source, const char *options)
{
    const char *parts[] = {EC_CACHE_MAGIC,  source,         options,
                           device->name,    device->vendor, device->version,
                           device->driver,  device->platform_name, device->platform_version};
    ec_sha256 hash;
    ec_sha256_begin(&hash);
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) add_text(&hash, parts[i]);
    ec_cache_key key;
    ec_sha256_end(&hash, key.bytes);
    ec_sha256_write(key.bytes, sizeof key.bytes, key.hex);
    return key;
}

bool ec_cache_folder(const char *chosen, char *path, size_t size)
{
    const char *xdg = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int length;
    if (chosen) length = snprintf(path, size, "%s", chosen);
    else if (xdg && xdg[0] == '/') length = snprintf(path, size, "%s/eclat/kernels", xdg); /* XDG: relative = unset */
    else if (home && home[0] == '/') length = snprintf(path, size, "%s/.cache/eclat/kernels", home);
    else return false;
    return length > 0 && (size_t)length < size;
}

static bool read_all(int file, void *to, size_t bytes)
{
    for (size_t done = 0; done < bytes;) {
        ssize_t got = read(file, (char *)to + done, bytes - done);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        done += (size_t)got;
    }
    return true;
}

static bool header_fits(const cache_header *header, const ec_cache_key *key, uint64_t file_bytes)
{
    return memcmp(header->magic, EC_CACHE_MAGIC, sizeof header->magic) == 0 &&
           memcmp(header->key, key->bytes, sizeof header->key) == 0 && header->bytes > 0 &&
           header->bytes <= EC_CACHE_LARGEST && file_bytes == sizeof *header + header->bytes;
}

static bool read_entry(int file, const ec_cache_key *key, unsigned char **binary, size_t *bytes)
{
    cache_header header;
    struct stat status;
    if (fstat(file, &status) != 0 || !read_all(file, &header, sizeof header)) return false;
    if (!header_fits(&header, key, (uint64_t)status.st_size)) return false;
    unsigned char *data = malloc(header.bytes);
    uint8_t checksum[32];
    bool good = data && read_all(file, data, header.bytes);
    if (good) {
        sha256(data, header.bytes, checksum);
        good = memcmp(checksum, header.checksum, sizeof checksum) == 0;
    }
    if (!good) {
        free(data);
        return false;
    }
    *binary = data;
    *bytes = header.bytes;
    return true;
}

bool ec_cache_load(const char *folder, const ec_cache_key *key, unsigned char **binary, size_t *bytes)
{
    char path[4096];
    if (snprintf(path, sizeof path, "%s/%s.bin", folder, key->hex) >= (int)sizeof path) return false;
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* O_NONBLOCK: does not hang on a FIFO of that name */
    if (file < 0) return false;
    bool good = read_entry(file, key, binary, bytes);
    close(file);
    return good;
}

bool ec_cache_make_folder(const char *folder)
{
    char path[4096];
    if (snprintf(path, sizeof path, "%s", folder) >= (int)sizeof path) return false;
    for (char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = 0;
        if (mkdir(path, 0700) != 0 && errno != EEXIST) return false;
        *slash = '/';
    }
    return mkdir(path, 0700) == 0 || errno == EEXIST;
}

bool ec_cache_store(const char *folder, const ec_cache_key *key, const unsigned char *binary, size_t bytes)
{
    char path[4096];
    ec_error ignored;
    if (snprintf(path, sizeof path, "%s/%s.bin", folder, key->hex) >= (int)sizeof path || !ec_cache_make_folder(folder)) return false;
    cache_header header = {.bytes = bytes};
    memcpy(header.magic, EC_CACHE_MAGIC, sizeof header.magic);
    memcpy(header.key, key->bytes, sizeof header.key);
    sha256(binary, bytes, header.checksum);
    ec_atomic_file file;
    if (ec_atomic_open(&file, path, &ignored) != EC_OK) return false;
    (void)fchmod(file.fd, 0600);
    return ec_atomic_append(&file, &header, sizeof header, &ignored) == EC_OK &&
           ec_atomic_append(&file, binary, bytes, &ignored) == EC_OK && ec_atomic_commit(&file, &ignored) == EC_OK;
}
