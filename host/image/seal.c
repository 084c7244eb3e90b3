#include "image/seal.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/sha256.h"
#include "image/image.h"

static const char mark[] = "eclat: sealed by SHA-256\n";
enum { MARK_SIZE = sizeof mark - 1, SEAL_SIZE = MARK_SIZE + EC_SHA256_BYTES };

/* Computes the digest of the first `size` bytes. Returns 0 or an errno value. */
static int digest_of(int fd, off_t size, uint8_t digest[EC_SHA256_BYTES])
{
    ec_sha256 hash;
    ec_sha256_begin(&hash);
    const int failed = ec_sha256_add_file(&hash, fd, (uint64_t)size);
    ec_sha256_end(&hash, digest);
    return failed;
}

int ec_seal(int fd)
{
    uint8_t seal[SEAL_SIZE];
    off_t size = lseek(fd, 0, SEEK_END);
    if (size < 0) return errno;
    memcpy(seal, mark, MARK_SIZE);
    int failed = digest_of(fd, size, seal + MARK_SIZE);
    return failed ? failed : ec_write_all(fd, seal, SEAL_SIZE, size);
}

static ec_result check(int fd, const char *path, ec_error *err)
{
    uint8_t seal[SEAL_SIZE], digest[EC_SHA256_BYTES];
    off_t size = lseek(fd, 0, SEEK_END);
    int is_sealed = size > SEAL_SIZE && pread(fd, seal, SEAL_SIZE, size - SEAL_SIZE) == SEAL_SIZE && !memcmp(seal, mark, MARK_SIZE);
    if (!is_sealed)
        return ec_fail(err, "cannot read '%s': it is not a checkpoint or slice of eclat, or is cut short; give the file that --checkpoint "
                            "or --samples wrote", path);
    int failed = digest_of(fd, size - SEAL_SIZE, digest);
    if (failed) return ec_fail(err, "cannot read '%s': %s", path, strerror(failed));
    if (!memcmp(digest, seal + MARK_SIZE, sizeof digest)) return EC_OK;
    return ec_fail(err, "cannot read '%s': its checksum does not match, so it is damaged; use an older one or render it again", path);
}

ec_result ec_seal_check(const char *path, ec_error *err)
{
    EC_TRY(ec_image_check_regular(path, err));
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0) return ec_fail(err, "cannot open '%s': %s; check the path and its permissions", path, strerror(errno));
    ec_result result = check(fd, path, err);
    close(fd);
    return result;
}
