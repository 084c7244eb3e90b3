/* tier: quick */
/* Several parts in one sealed file: every bit is kept, other readers see the first part as a picture, and a changed file is refused. */
#include <stdlib.h>

#include "image/exr_parts.h"
#include "image/image.h"
#include "image/seal.h"
#include "support/test.h"

enum { W = 37, H = 21, P = W * H };
#define PATH ECLAT_TEST_OUT "/parts.exr"

static double doubles[2 * P];
static float floats[P];

static void fill(void)
{
    for (int i = 0; i < 2 * P; i++) doubles[i] = i % 7 == 0 ? -1.0 / (i + 1) : i % 11 == 0 ? INFINITY : i % 13 == 0 ? NAN : exp(i * 0.3 - 200);
    for (int i = 0; i < P; i++) floats[i] = (float)i / 3;
}

static void write_file(void)
{
    ec_error err;
    const ec_channel picture[] = {{"R", floats, 1, EC_CHANNEL_FLOAT}, {"G", floats, 1, EC_CHANNEL_FLOAT}, {"B", floats, 1, EC_CHANNEL_FLOAT}};
    const float *words = (const float *)doubles;
    const ec_channel sums[] = {{"b.low", words + 2, 4, EC_CHANNEL_WORDS}, {"a.low", words, 4, EC_CHANNEL_WORDS}, {"a.high", words + 1, 4, EC_CHANNEL_WORDS},
                               {"b.high", words + 3, 4, EC_CHANNEL_WORDS}};
    const ec_attribute text = {.name = "eclat.state", .type = EC_ATTR_STRING, .string = "{\"a\": 1}"};
    const ec_exr_part parts[] = {{"picture", picture, 3, &text, 1, false}, {"sums", sums, 4, NULL, 0, true}, {"more", picture, 2, NULL, 0, false}};
    CHECK_OK(ec_exr_write_parts(PATH, W, H, parts, 3, &err), err);
}

static void every_bit_comes_back(void)
{
    static double back[2 * P];
    static float red[P];
    ec_exr_file *file;
    uint32_t width, height;
    ec_error err;
    CHECK_OK(ec_exr_open(PATH, &file, &width, &height, &err), err);
    CHECK(width == W && height == H && !strcmp(ec_exr_text(file, "eclat.state"), "{\"a\": 1}") && !ec_exr_text(file, "eclat.other"));
    uint32_t *words = (uint32_t *)back;
    const ec_exr_room rooms[] = {{"a.low", words, 4}, {"a.high", words + 1, 4}, {"b.low", words + 2, 4}, {"b.high", words + 3, 4}};
    CHECK_OK(ec_exr_fill(file, "sums", rooms, 4, &err), err);
    CHECK(!memcmp(doubles, back, sizeof back));
    CHECK_OK(ec_exr_fill(file, "picture", &(ec_exr_room){"R", red, 1}, 1, &err), err);
    CHECK(!memcmp(floats, red, sizeof red));
    CHECK(ec_exr_has(file, "more", "G") && !ec_exr_has(file, "more", "B") && !ec_exr_has(file, "none", "G"));
    CHECK(ec_exr_fill(file, "more", &(ec_exr_room){"B", red, 1}, 1, &err) == EC_FAILED && strstr(err.text, "has no 32-bit channel 'B'"));
    ec_exr_close(file);
    ec_exr picture;
    CHECK_OK(ec_exr_read(PATH, &picture, &err), err);
    CHECK(picture.channel_count == 3 && !memcmp(ec_exr_plane(&picture, "R"), floats, sizeof floats));
    ec_exr_free(&picture);
}

static void write_bytes(const char *bytes, size_t size)
{
    FILE *out = fopen(PATH, "wb");
    CHECK(out && fwrite(bytes, 1, size, out) == size && fclose(out) == 0);
}

/* Testing every bit and every length would take long: tests some of each, including the ends. */
static void what_was_changed_is_refused(void)
{
    static char bytes[1 << 17];
    FILE *in = fopen(PATH, "rb");
    size_t size = fread(bytes, 1, sizeof bytes, in);
    ec_error err;
    fclose(in);
    CHECK(size > 1000 && size < sizeof bytes);
    for (size_t i = 0; i < size; i += i < 400 || i + 200 > size ? 7 : 97) {
        bytes[i] ^= (char)(1 << i % 8);
        write_bytes(bytes, size);
        CHECK_MSG(ec_seal_check(PATH, &err) == EC_FAILED && strstr(err.text, "; "), "bit of byte %zu: %s", i, err.text);
        bytes[i] ^= (char)(1 << i % 8);
    }
    for (size_t i = 0; i < size; i += i < 100 || i + 100 > size ? 1 : 501) {
        write_bytes(bytes, i);
        CHECK_MSG(ec_seal_check(PATH, &err) == EC_FAILED && strstr(err.text, "; "), "%zu bytes: %s", i, err.text);
    }
    write_bytes(bytes, size);
    CHECK_OK(ec_seal_check(PATH, &err), err);
}

int main(void)
{
    fill();
    write_file();
    every_bit_comes_back();
    what_was_changed_is_refused();
    TEST_END();
}
