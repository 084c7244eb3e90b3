/* tier: quick */
/* All threads compress pictures: files have equal bytes for any number of threads and of rows at a time, and hold equal values. */
#include <omp.h>
#include <png.h>
#include <stdlib.h>

#include "image/image.h"
#include "support/test.h"

/* 2703 bytes a row make 96 rows a strip: 5 strips, the last of 19 rows; and 26 chunks of an EXR, the last of 3. */
enum { W = 901, H = 403, P = W * H };
#define FIRST ECLAT_TEST_OUT "/threads-first"
#define OTHER ECLAT_TEST_OUT "/threads-other"

static float values[3 * P];
static uint8_t bytes[3 * P];

/* Part smooth, part noise, so that rows get different filters and some chunks do not shrink. */
static void fill(void)
{
    uint32_t state = 1;
    for (int i = 0; i < 3 * P; i++) {
        const uint32_t x = (uint32_t)i / 3 % W, y = (uint32_t)i / 3 / W;
        state = state * 1664525u + 1013904223u;
        bytes[i] = (uint8_t)(y % 40 < 10 ? state >> 24 : y % 40 < 20 ? x / 4 : y % 40 < 30 ? y : (x + y) / 8 + (state >> 30));
        memcpy(&values[i], &(uint32_t){y < 100 ? state >> 2 : 0x3f800000u + x * y}, 4); /* finite */
    }
}

static void check_same_bytes(const char *a, const char *b)
{
    FILE *left = fopen(a, "rb"), *right = fopen(b, "rb");
    CHECK(left && right);
    long count = 0, differ = 0;
    for (int x = 0; x != EOF; count++) {
        x = fgetc(left);
        differ += x != fgetc(right);
    }
    CHECK(count > 1000 && differ == 0);
    fclose(left);
    fclose(right);
}

static void write_png(const char *path, uint32_t rows_a_put)
{
    ec_png_rows *rows;
    ec_error err;
    CHECK_OK(ec_png_rows_begin(&rows, path, &(ec_raster){W, H, 3, 8}, NULL, &err), err);
    for (uint32_t y = 0; y < H; y += rows_a_put)
        CHECK_OK(ec_png_rows_put(rows, bytes + 3 * W * y, H - y < rows_a_put ? H - y : rows_a_put, &err), err);
    CHECK_OK(ec_png_rows_end(rows, &err), err);
}

static void png_is_the_picture(const char *path)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    uint8_t *read = malloc(3 * P);
    CHECK(png_image_begin_read_from_file(&image, path) && image.width == W && image.height == H);
    image.format = PNG_FORMAT_RGB;
    CHECK(read && png_image_finish_read(&image, NULL, read, 0, NULL) && !image.warning_or_error);
    CHECK(!memcmp(read, bytes, 3 * P));
    free(read);
}

static void pngs(void)
{
    omp_set_num_threads(1);
    write_png(FIRST ".png", H);
    png_is_the_picture(FIRST ".png");
    static const int threads[] = {2, 3, 7}; /* 7: more than there are strips */
    for (int i = 0; i < 3; i++) {
        omp_set_num_threads(threads[i]);
        write_png(OTHER ".png", i == 1 ? 61 : H);
        check_same_bytes(FIRST ".png", OTHER ".png");
    }
}

static void write_exr(const char *path)
{
    static const char *const names[3] = {"R", "stderr.G", "B"};
    ec_channel channels[3];
    ec_error err;
    for (uint32_t c = 0; c < 3; c++) channels[c] = (ec_channel){names[c], values + c, 3, false};
    const ec_exr_part parts[3] = {{.name = "picture", .channels = channels, .channel_count = 3},
                                  {.name = "plain", .channels = channels, .channel_count = 2, .is_plain = true},
                                  {.name = "last", .channels = channels, .channel_count = 1}};
    CHECK_OK(ec_exr_write_parts(path, W, H, parts, 3, &err), err);
}

static void exrs(void)
{
    ec_exr exr;
    ec_error err;
    omp_set_num_threads(1);
    write_exr(FIRST ".exr");
    CHECK_OK(ec_exr_read(FIRST ".exr", &exr, &err), err);
    const float *plane = ec_exr_plane(&exr, "stderr.G");
    for (uint32_t p = 0; p < P && plane; p++) CHECK(plane[p] == values[3 * p + 1]);
    ec_exr_free(&exr);
    for (int threads = 2; threads <= 5; threads += 3) {
        omp_set_num_threads(threads);
        write_exr(OTHER ".exr");
        check_same_bytes(FIRST ".exr", OTHER ".exr");
    }
}

int main(void)
{
    fill();
    pngs();
    exrs();
    TEST_END();
}
