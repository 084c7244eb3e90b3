/* tier: quick */
/* Radiance pictures made by hand: both run-length encodings and plain pixels, and files cut anywhere. */
#include "image/hdr.h"
#include "image/image.h"
#include "support/test.h"

static const char *const path = ECLAT_TEST_OUT "/picture.hdr";
static ec_error err;
static uint32_t width, height;
static float *rgb;

static ec_result read_bytes(const char *header, const unsigned char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    fputs(header, file);
    if (size) fwrite(bytes, 1, size, file);
    fclose(file);
    free(rgb);
    err.text[0] = 0;
    return ec_image_read_rgb(path, &width, &height, &rgb, &err);
}

#define HEADER "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n"

static void plain_pixels(void)
{
    /* 2^(136-136) = 1; exponent 0 is black; the largest and smallest values. */
    const unsigned char bytes[] = {128, 64, 1, 136, 9, 9, 9, 0, 255, 255, 255, 255, 1, 0, 0, 1};
    const float expected[] = {128, 64, 1, 0, 0, 0, 255 * 0x1p119f, 255 * 0x1p119f, 255 * 0x1p119f, 0x1p-135f, 0, 0};
    CHECK_OK(read_bytes("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\nEXPOSURE=0.5\n\n-Y 2 +X 2\n", bytes, sizeof bytes), err);
    CHECK(!ec_hdr_has_exposure(path)); /* such headers multiply */
    CHECK_OK(read_bytes(HEADER "-Y 2 +X 2\n", bytes, sizeof bytes), err);
    CHECK(ec_hdr_has_exposure(path));
    CHECK(width == 2 && height == 2 && rgb && memcmp(rgb, expected, sizeof expected) == 0);
}

static void old_runs(void)
{
    /* One pixel, 3 more, then 1 << 8 more, then nothing: counts of successive runs are shifted by 8 bits. */
    const unsigned char bytes[] = {8, 4, 2, 136, 1, 1, 1, 3, 1, 1, 1, 1, 7, 7, 7, 136};
    CHECK_OK(read_bytes(HEADER "-Y 1 +X 261\n", bytes, sizeof bytes), err);
    CHECK(width == 261 && rgb && rgb[3 * 259] == 8 && rgb[3 * 259 + 2] == 2 && rgb[3 * 260] == 7);
    const unsigned char first[] = {1, 1, 1, 3, 0, 0, 0, 0};
    CHECK(read_bytes(HEADER "-Y 1 +X 4\n", first, sizeof first) == EC_FAILED && strstr(err.text, "run"));
}

static const unsigned char runs[] = {2, 2, 0, 9, 137, 5, 4, 1, 2, 3, 4, 133, 6, 129, 7, 8, 8, 7, 6, 5, 4, 3, 2, 1, 137, 136};
static const float run_values[3][9] = {{5, 5, 5, 5, 5, 5, 5, 5, 5}, {1, 2, 3, 4, 6, 6, 6, 6, 6}, {7, 8, 7, 6, 5, 4, 3, 2, 1}};

static void new_runs(void)
{
    CHECK_OK(read_bytes(HEADER "-Y 1 +X 9\n", runs, sizeof runs), err);
    for (int i = 0; rgb && i < 27; i++) CHECK(rgb[i] == run_values[i % 3][i / 3]);
    unsigned char broken[sizeof runs];
    memcpy(broken, runs, sizeof runs);
    broken[4] = 138; /* one pixel too many */
    CHECK(read_bytes(HEADER "-Y 1 +X 9\n", broken, sizeof runs) == EC_FAILED && strstr(err.text, "run leaves"));
    broken[4] = 0;
    CHECK(read_bytes(HEADER "-Y 1 +X 9\n", broken, sizeof runs) == EC_FAILED && strstr(err.text, "run leaves"));
    CHECK(read_bytes(HEADER "-Y 1 +X 10\n", runs, sizeof runs) == EC_FAILED && strstr(err.text, "wrong width"));
}

/* Longer than one read: runs and pixels cross the limits. */
static void many_blocks(void)
{
    enum { WIDTH = 613, HEIGHT = 300 };
    static unsigned char file[HEIGHT * (4 + 8 * WIDTH)], values[HEIGHT][4][WIDTH];
    unsigned char *out = file;
    uint32_t noise = 1;
    for (int y = 0; y < HEIGHT; y++) {
        const unsigned char start[4] = {2, 2, WIDTH >> 8, WIDTH & 255};
        memcpy(out, start, 4), out += 4;
        for (int k = 0; k < 4; k++)
            for (int x = 0, count; x < WIDTH; x += count) {
                noise = noise * 1664525u + 1013904223u;
                bool repeat = noise >> 31;
                count = 1 + (int)(noise >> 24) % (repeat ? 127 : 128);
                if (count > WIDTH - x) count = WIDTH - x;
                *out++ = (unsigned char)(repeat ? 128 + count : count);
                for (int i = 0; i < count; i++) {
                    if (!repeat || i == 0) noise = noise * 1664525u + 1013904223u, *out++ = (unsigned char)(noise >> 24);
                    values[y][k][x + i] = out[-1];
                }
            }
    }
    CHECK(out - file > 3 * 65536);
    CHECK_OK(read_bytes(HEADER "-Y 300 +X 613\n", file, (size_t)(out - file)), err);
    size_t wrong = 0;
    for (int i = 0; rgb && i < 3 * WIDTH * HEIGHT; i++) {
        const int x = i / 3 % WIDTH, y = i / 3 / WIDTH, e = values[y][3][x];
        wrong += rgb[i] != (e ? ldexpf(values[y][i % 3][x], e - 136) : 0);
    }
    CHECK_MSG(width == WIDTH && height == HEIGHT && rgb && !wrong, "%zu values", wrong);
    CHECK(read_bytes(HEADER "-Y 300 +X 613\n", file, (size_t)(out - file) - 1) == EC_FAILED && strstr(err.text, "too early"));
}

static void every_truncation_is_an_error(void)
{
    for (size_t size = 0; size < sizeof runs; size++) {
        CHECK_MSG(read_bytes(HEADER "-Y 1 +X 9\n", runs, size) == EC_FAILED && rgb == NULL, "%zu bytes", size);
        CHECK_MSG(strstr(err.text, "too early") && strstr(err.text, path), "%zu bytes: %s", size, err.text);
    }
    CHECK(read_bytes(HEADER "-Y 2 +X 9\n", runs, sizeof runs) == EC_FAILED && strstr(err.text, "too early"));
    char header[] = HEADER "-Y 1 +X 9\n";
    for (size_t length = strlen(header); length-- > 0;) {
        header[length] = 0;
        CHECK_MSG(read_bytes(header, NULL, 0) == EC_FAILED && !strchr(err.text, '\n'), "%s", header);
    }
}

static void strange_headers_are_named(void)
{
    CHECK(read_bytes("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 9\n", runs, sizeof runs) == EC_FAILED);
    CHECK_MSG(strstr(err.text, "FORMAT") != NULL, "%s", err.text);
    CHECK(read_bytes("#?RGBE\n\n-Y 1 +X 9\n", runs, sizeof runs) == EC_FAILED && strstr(err.text, "FORMAT"));
    CHECK(read_bytes(HEADER "+Y 1 +X 9\n", runs, sizeof runs) == EC_FAILED && strstr(err.text, "-Y height"));
    CHECK(read_bytes(HEADER "-Y 0 +X 9\n", runs, sizeof runs) == EC_FAILED && strstr(err.text, "size"));
    CHECK(read_bytes(HEADER "-Y 9999999 +X 9\n", runs, sizeof runs) == EC_FAILED && strstr(err.text, "size"));
    CHECK(read_bytes("GIF89a", runs, sizeof runs) == EC_FAILED && strstr(err.text, "neither"));
    CHECK(read_bytes("", NULL, 0) == EC_FAILED && strstr(err.text, "empty"));
    CHECK(ec_image_read_rgb(ECLAT_TEST_OUT, &width, &height, &rgb, &err) == EC_FAILED &&
          strstr(err.text, "it is a folder"));
    CHECK(ec_image_read_rgb(ECLAT_TEST_OUT "/none.hdr", &width, &height, &rgb, &err) == EC_FAILED);
    CHECK_MSG(strstr(err.text, "none.hdr': No such file") != NULL, "%s", err.text);
}

/* EXR by the same function: RGB, grey, and neither. */
static void an_exr_is_known_by_its_content(void)
{
    const float data[6] = {1, 2, 3, 4, 5, 6};
    const ec_channel colour[] = {{"B", data + 4, 1}, {"G", data + 2, 1}, {"R", data, 1}}, grey = {"Y", data, 1},
                     depth = {"depth.Z", data, 1};
    CHECK_OK(ec_exr_write(path, 2, 1, colour, 3, NULL, 0, &err), err);
    CHECK_OK(ec_image_read_rgb(path, &width, &height, &rgb, &err), err);
    CHECK(width == 2 && height == 1 && rgb[0] == 1 && rgb[1] == 3 && rgb[2] == 5 && rgb[3] == 2 && rgb[5] == 6);
    free(rgb);
    CHECK_OK(ec_exr_write(path, 2, 1, &grey, 1, NULL, 0, &err), err);
    CHECK_OK(ec_image_read_rgb(path, &width, &height, &rgb, &err), err);
    CHECK(rgb[0] == 1 && rgb[1] == 1 && rgb[2] == 1 && rgb[3] == 2);
    free(rgb);
    CHECK_OK(ec_exr_write(path, 2, 1, &depth, 1, NULL, 0, &err), err);
    CHECK(ec_image_read_rgb(path, &width, &height, &rgb, &err) == EC_FAILED && strstr(err.text, "depth.Z") && rgb == NULL);
}

/* Values as stb_image 2.28 reads them. */
static void a_shared_file_has_its_values(void)
{
    const char *shared = ECLAT_SHARED "/assets/env/pmndrs-assets/studio.hdr";
    FILE *file = fopen(shared, "rb");
    if (!file) return;
    fclose(file);
    CHECK_OK(ec_image_read_rgb(shared, &width, &height, &rgb, &err), err);
    double sum[3] = {0};
    for (uint64_t i = 0; rgb && i < 3ull * width * height; i++) sum[i % 3] += rgb[i];
    CHECK(width == 1024 && height == 512);
    CHECK_NEAR(sum[0], 857711.4383, 1e-3);
    CHECK_NEAR(sum[1], 986880.759079, 1e-3);
    CHECK_NEAR(sum[2], 1115401.21478, 1e-3);
    free(rgb);
    rgb = NULL;
}

int main(void)
{
    plain_pixels();
    old_runs();
    new_runs();
    many_blocks();
    every_truncation_is_an_error();
    strange_headers_are_named();
    an_exr_is_known_by_its_content();
    a_shared_file_has_its_values();
    remove(path);
    TEST_END();
}
