/* tier: quick */
/* Decoding PNG and JPEG: every colour type becomes four channels; broken files are refused. The files were made with Python's zlib and
 * libjpeg. */
#include "gltf/image_decode.h"

#include "support/test.h"

/* 2 bits, palette red, green, blue, (9, 8, 7); alpha 255, 128, 0, none */
static const unsigned char palette[] = {
    137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 4, 0, 0, 0, 1, 2, 3, 0, 0, 0,
    132, 82, 231, 94, 0, 0, 0, 12, 80, 76, 84, 69, 255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 8, 7, 162, 210, 98,
    192, 0, 0, 0, 3, 116, 82, 78, 83, 255, 128, 0, 127, 109, 104, 120, 0, 0, 0, 10, 73, 68, 65, 84, 120,
    156, 99, 144, 6, 0, 0, 29, 0, 28, 142, 244, 245, 33, 0, 0, 0, 0, 73, 69, 78, 68, 174, 66, 96, 130};
static const unsigned char one_bit_grey[] = {
    137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 2, 0, 0, 0, 1, 1, 0, 0, 0, 0,
    220, 89, 66, 39, 0, 0, 0, 10, 73, 68, 65, 84, 120, 156, 99, 112, 0, 0, 0, 66, 0, 65, 41, 55, 244, 239,
    0, 0, 0, 0, 73, 69, 78, 68, 174, 66, 96, 130}; /* black, white */
static const unsigned char grey_alpha_16[] = {
    137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 1, 0, 0, 0, 1, 16, 4, 0, 0, 0,
    229, 140, 208, 65, 0, 0, 0, 13, 73, 68, 65, 84, 120, 156, 99, 16, 50, 89, 125, 22, 0, 3, 12, 1, 191,
    110, 185, 198, 93, 0, 0, 0, 0, 73, 69, 78, 68, 174, 66, 96, 130}; /* 0x1234, 0xabcd */
static const unsigned char interlaced[] = {
    137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 2, 0, 0, 0, 2, 8, 2, 0, 0, 1,
    138, 211, 170, 229, 0, 0, 0, 23, 73, 68, 65, 84, 120, 156, 99, 96, 100, 98, 102, 96, 97, 101, 99, 96,
    231, 224, 228, 226, 230, 1, 0, 1, 150, 0, 79, 144, 180, 171, 112, 0, 0, 0, 0, 73, 69, 78, 68, 174, 66,
    96, 130}; /* 2x2: 1 2 3 | 4 5 6 // 7 8 9 | 10 11 12 */
static const unsigned char jpeg[] = {
    255, 216, 255, 224, 0, 16, 74, 70, 73, 70, 0, 1, 1, 0, 0, 1, 0, 1, 0, 0, 255, 219, 0, 67, 0, 1, 1, 1, 1,
    1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
    1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 255, 219, 0, 67, 1, 1, 1, 1,
    1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
    1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 255, 192, 0, 17, 8, 0, 8,
    0, 8, 3, 1, 17, 0, 2, 17, 1, 3, 17, 1, 255, 196, 0, 20, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 6, 255, 196, 0, 20, 16, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 196, 0, 20, 1, 1, 0,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9, 255, 196, 0, 20, 17, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 255, 218, 0, 12, 3, 1, 0, 2, 17, 3, 17, 0, 63, 0, 62, 43, 205, 131, 255, 217}; /* 8x8, (200, 100, 50) everywhere */

static ec_image decode(const unsigned char *bytes, size_t size)
{
    ec_image image = {0};
    ec_decode_error err = {""};
    CHECK_MSG(ec_image_decode(bytes, size, &image, &err), "%s", err.text);
    return image;
}

static void release(ec_image *image)
{
    free(image->rgba8);
    free(image->rgba16);
}

static void expect_bytes(const unsigned char *file, size_t size, uint32_t width, uint32_t height, const uint8_t *expected)
{
    ec_image image = decode(file, size);
    CHECK(image.width == width && image.height == height && image.rgba8 && !image.rgba16);
    for (uint32_t i = 0; image.rgba8 && i < 4 * width * height; i++)
        CHECK_MSG(image.rgba8[i] == expected[i], "value %u is %u, not %u", i, image.rgba8[i], expected[i]);
    release(&image);
}

static void test_png(void)
{
    const uint8_t colors[] = {255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0, 9, 8, 7, 255};
    expect_bytes(palette, sizeof palette, 4, 1, colors);
    const uint8_t greys[] = {0, 0, 0, 255, 255, 255, 255, 255};
    expect_bytes(one_bit_grey, sizeof one_bit_grey, 2, 1, greys);
    const uint8_t squares[] = {1, 2, 3, 255, 4, 5, 6, 255, 7, 8, 9, 255, 10, 11, 12, 255};
    expect_bytes(interlaced, sizeof interlaced, 2, 2, squares);
    ec_image deep = decode(grey_alpha_16, sizeof grey_alpha_16);
    CHECK(deep.rgba16 && !deep.rgba8);
    if (deep.rgba16)
        CHECK(deep.rgba16[0] == 0x1234 && deep.rgba16[1] == 0x1234 && deep.rgba16[2] == 0x1234 && deep.rgba16[3] == 0xabcd);
    release(&deep);
}

static void test_jpeg(void)
{
    ec_image image = decode(jpeg, sizeof jpeg);
    const int expected[4] = {200, 100, 50, 255};
    CHECK(image.width == 8 && image.height == 8 && image.rgba8);
    for (int i = 0; image.rgba8 && i < 256; i++) CHECK_NEAR(image.rgba8[i], expected[i % 4], i % 4 == 3 ? 0 : 1);
    release(&image);
    /* Cut after its header: the size is read, and the message names the error. */
    ec_image cut = {0};
    ec_decode_error err = {""};
    CHECK(ec_image_decode(jpeg, sizeof jpeg, &cut, &err) && !err.text[0]);
    release(&cut);
    cut = (ec_image){0};
    CHECK(ec_image_decode(jpeg, sizeof jpeg - 6, &cut, &err) && cut.rgba8);
    CHECK_MSG(strstr(err.text, "Premature end of JPEG file"), "\"%s\"", err.text);
    release(&cut);
}

/* The caller's memory stays the caller's, whether decoding succeeds or not. */
static void test_room(void)
{
    uint8_t room[4 * 8 * 8];
    uint32_t width = 0, height = 0;
    ec_decode_error err = {""};
    CHECK(ec_image_size(jpeg, sizeof jpeg, &width, &height) && width == 8 && height == 8);
    ec_image image = {.width = 8, .height = 8, .rgba8 = room};
    CHECK(ec_image_decode(jpeg, sizeof jpeg, &image, &err) && image.rgba8 == room);
    CHECK_NEAR(room[255 - 1], 50, 1);
    CHECK(ec_image_size(palette, sizeof palette, &width, &height) && width == 4 && height == 1);
    image = (ec_image){.width = 4, .height = 1, .rgba8 = room};
    CHECK(ec_image_decode(palette, sizeof palette, &image, &err) && image.rgba8 == room && room[5] == 255);
    for (size_t cut = 34; cut < sizeof palette - 12; cut++) CHECK(!ec_image_decode(palette, cut, &image, &err) && image.rgba8 == room);
    CHECK(!ec_image_decode(jpeg, 100, &image, &err));
    CHECK(!ec_image_size(grey_alpha_16, sizeof grey_alpha_16, &width, &height)); /* this becomes another kind */
    for (size_t cut = 0; cut < 25; cut++) CHECK(!ec_image_size(palette, cut, &width, &height));
    for (size_t cut = 0; cut < 100; cut++) CHECK(!ec_image_size(jpeg, cut, &width, &height));
}

static void expect_refusal(const unsigned char *bytes, size_t size, const char *needle)
{
    ec_image image = {0};
    ec_decode_error err = {""};
    CHECK(!ec_image_decode(bytes, size, &image, &err) && !image.rgba8 && !image.rgba16);
    CHECK_MSG(strstr(err.text, needle) != NULL, "\"%s\" does not say \"%s\"", err.text, needle);
    release(&image);
}

static void test_broken(void)
{
    unsigned char copy[1024];
    expect_refusal(palette, 0, "not a PNG, JPEG, WebP, AVIF or KTX2");
    expect_refusal((const unsigned char *)"GIF89a..........", 16, "not a PNG, JPEG, WebP, AVIF or KTX2");
    for (size_t cut = 8; cut < sizeof palette - 12; cut++) expect_refusal(palette, cut, "");
    memcpy(copy, jpeg, sizeof jpeg);
    for (size_t cut = 3; cut < 100; cut++) expect_refusal(copy, cut, "");
    /* A JPEG whose header claims 16384 x 16384, then 16385; its size is after the SOF0 marker. */
    for (size_t i = 0; i + 9 < sizeof jpeg; i++) {
        if (copy[i] != 0xff || copy[i + 1] != 0xc0) continue;
        copy[i + 5] = copy[i + 7] = 0x40;
        copy[i + 6] = copy[i + 8] = 0;
        expect_refusal(copy, sizeof jpeg, "more pixels than its bytes");
        copy[i + 8] = 1;
        expect_refusal(copy, sizeof jpeg, "16384");
    }
    /* A Huffman table of 16 x 255 codes overruns stb_image 2.27. */
    memcpy(copy, jpeg, sizeof jpeg);
    for (size_t i = 0; i + 21 < sizeof jpeg; i++)
        if (copy[i] == 0xff && copy[i + 1] == 0xc4) memset(copy + i + 5, 255, 16);
    expect_refusal(copy, sizeof jpeg, "");
}

int main(void)
{
    test_png();
    test_jpeg();
    test_room();
    test_broken();
    TEST_END();
}
