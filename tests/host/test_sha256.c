/* tier: quick */
/* Digests of FIPS 180-4's examples, whole and in pieces, from memory and from files; a file that is too short is reported. */
#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

#include "base/sha256.h"
#include "support/test.h"

static const char of_nothing[] = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
static const char of_abc[] = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
static const char of_million[] = "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"; /* times 'a' */
enum { MILLION = 1000000 };

static char many[2 * MILLION];

static void check_pieces(size_t piece)
{
    char text[EC_SHA256_TEXT];
    ec_sha256 hash;
    ec_sha256_begin(&hash);
    for (size_t done = 0; done < MILLION; done += piece) ec_sha256_add(&hash, many + done, MILLION - done < piece ? MILLION - done : piece);
    ec_sha256_end_text(&hash, text);
    CHECK_MSG(!strcmp(text, of_million), "in pieces of %zu: %s", piece, text);
}

static void check_file(const char *path, size_t size, const char *digest)
{
    char text[EC_SHA256_TEXT] = "";
    FILE *file = fopen(path, "wb");
    CHECK(file && fwrite(many, 1, size, file) == size && fclose(file) == 0);
    CHECK(ec_sha256_file(path, text));
    CHECK_MSG(!strcmp(text, digest), "%zu bytes: %s", size, text);
}

int main(void)
{
    char text[EC_SHA256_TEXT], path[] = "/tmp/eclat-sha256-XXXXXX";
    ec_sha256 hash;
    memset(many, 'a', sizeof many);
    ec_sha256_begin(&hash);
    ec_sha256_add(&hash, NULL, 0);
    ec_sha256_end_text(&hash, text);
    CHECK(!strcmp(text, of_nothing));
    ec_sha256_begin(&hash);
    ec_sha256_add(&hash, "abc", 3);
    ec_sha256_end_text(&hash, text);
    CHECK(!strcmp(text, of_abc));
    check_pieces(MILLION);
    check_pieces(63);
    check_pieces(65);
    const int fd = mkstemp(path);
    CHECK(fd >= 0);
    check_file(path, 0, of_nothing);
    check_file(path, MILLION, of_million);
    for (size_t i = MILLION; i < sizeof many; i++) many[i] = (char)(i >> 8);
    ec_sha256_begin(&hash);
    ec_sha256_add(&hash, many, sizeof many);
    ec_sha256_end_text(&hash, text);
    check_file(path, sizeof many, text); /* more than one read */
    ec_sha256_begin(&hash);
    CHECK(ec_sha256_add_file(&hash, fd, MILLION) == 0); /* its beginning */
    ec_sha256_end_text(&hash, text);
    CHECK(!strcmp(text, of_million));
    ec_sha256_begin(&hash);
    CHECK(ec_sha256_add_file(&hash, fd, sizeof many + 1) == EIO);
    close(fd);
    unlink(path);
    CHECK(!ec_sha256_file(path, text));
    TEST_END();
}
