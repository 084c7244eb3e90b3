/* tier: quick */
/* Pictures written row by row equal those written at once; an EXR's attributes may change until the end. */
#include <stdlib.h>
#include <sys/stat.h>

#include "image/exr_header.h"
#include "image/image.h"
#include "support/test.h"

enum { W = 33, H = 53, P = W * H };
#define WHOLE ECLAT_TEST_OUT "/rows-whole"
#define ROWS ECLAT_TEST_OUT "/rows-rows"

static float values[3 * P];
static uint8_t bytes[3 * P];

static void fill(void)
{
    for (int i = 0; i < 3 * P; i++) values[i] = (float)i / 7 - 100, bytes[i] = (uint8_t)(i * i >> 4);
}

static size_t load(const char *path, uint8_t **data)
{
    FILE *in = fopen(path, "rb");
    CHECK(in);
    *data = malloc(1 << 20);
    size_t size = fread(*data, 1, 1 << 20, in);
    fclose(in);
    return size;
}

static void check_same_bytes(const char *a, const char *b)
{
    uint8_t *left, *right;
    size_t size = load(a, &left);
    CHECK(size > 1000 && size == load(b, &right) && !memcmp(left, right, size));
    free(left);
    free(right);
}

static void channels_from(ec_channel channels[3], uint32_t row)
{
    static const char *const names[3] = {"R", "stderr.G", "B"};
    for (uint32_t c = 0; c < 3; c++) channels[c] = (ec_channel){names[c], values + 3 * W * row + c, 3, false};
}

/* Writes 16, 32 and 5 rows at a time. Attributes are those of `begin` first, and those of `end` when the file is finished. */
static ec_result write_exr(const ec_attribute *begin, const ec_attribute *end, uint32_t count, uint32_t room, ec_error *err)
{
    static const uint32_t puts[] = {16, 32, 5};
    ec_channel channels[3];
    channels_from(channels, 0);
    const ec_exr_part part = {.name = "", .channels = channels, .channel_count = 3, .attributes = begin, .attribute_count = count};
    ec_exr_rows *rows;
    EC_TRY(ec_exr_rows_begin(&rows, ROWS ".exr", W, H, &part, 1, room, err));
    for (uint32_t i = 0, row = 0; i < 3; row += puts[i++]) {
        ec_channel here[3];
        channels_from(here, row);
        const ec_exr_part rest = {.channels = here, .channel_count = 3};
        CHECK_OK(ec_exr_rows_put(rows, &rest, puts[i], err), *err);
    }
    return ec_exr_rows_end(rows, end, count, err);
}

static void exr_rows(void)
{
    ec_error err;
    ec_channel channels[3];
    channels_from(channels, 0);
    const ec_attribute begin[2] = {{"eclat.hash", EC_ATTR_STRING, "0000", 0}, {"eclat.error", EC_ATTR_DOUBLE, NULL, 1}};
    const ec_attribute end[2] = {{"eclat.hash", EC_ATTR_STRING, "cafe", 0}, {"eclat.error", EC_ATTR_DOUBLE, NULL, 0.25}};
    CHECK_OK(ec_exr_write(WHOLE ".exr", W, H, channels, 3, end, 2, &err), err);
    CHECK_OK(write_exr(begin, end, 2, 0, &err), err);
    check_same_bytes(WHOLE ".exr", ROWS ".exr");
    CHECK_OK(write_exr(end, NULL, 2, 0, &err), err); /* nothing new is known */
    check_same_bytes(WHOLE ".exr", ROWS ".exr");
}

/* Longer and shorter attributes, within the reserved room; without room the file is not written. */
static void exr_attributes_of_other_lengths(void)
{
    static char longer[65], too_long[200];
    const ec_attribute begin = {"eclat.how", EC_ATTR_STRING, "spp", 0};
    const char *texts[] = {"user", "", "s", longer};
    double number;
    ec_error err;
    memset(longer, 'x', 64);
    memset(too_long, 'x', 199);
    for (int i = 0; i < 4; i++) {
        const ec_attribute end = {"eclat.how", EC_ATTR_STRING, texts[i], 0};
        remove(ROWS ".exr");
        CHECK_OK(write_exr(&begin, &end, 1, 100, &err), err);
        ec_exr exr;
        CHECK_OK(ec_exr_read(ROWS ".exr", &exr, &err), err);
        for (uint32_t p = 0; p < P; p++) CHECK(ec_exr_plane(&exr, "stderr.G")[p] == values[3 * p + 1]);
        ec_exr_free(&exr);
        CHECK(!ec_exr_number(ROWS ".exr", "eclat.how", &number));
        remove(ROWS ".exr");
        CHECK(write_exr(&begin, &end, 1, 0, &err) == EC_FAILED && strstr(err.text, "do not fit into its header"));
        struct stat info;
        CHECK(stat(ROWS ".exr", &info) != 0);
    }
    const ec_attribute end = {"eclat.how", EC_ATTR_STRING, too_long, 0};
    CHECK(write_exr(&begin, &end, 1, 100, &err) == EC_FAILED && strstr(err.text, "do not fit into its header"));
}

static void png_rows(void)
{
    static const uint32_t puts[] = {16, 1, 36};
    ec_png_rows *rows;
    ec_error err;
    CHECK_OK(ec_png_rows_begin(&rows, ROWS ".png", &(ec_raster){W, H, 3, 8}, NULL, &err), err);
    for (uint32_t i = 0, row = 0; i < 3; row += puts[i++]) CHECK_OK(ec_png_rows_put(rows, bytes + 3 * W * row, puts[i], &err), err);
    CHECK_OK(ec_png_rows_end(rows, &err), err);
    CHECK_OK(ec_png_write(WHOLE ".png", W, H, bytes, &err), err);
    check_same_bytes(WHOLE ".png", ROWS ".png");
}

/* Abandoned, and on a full disk: no new file, and an older one stays. */
static void nothing_half_written(void)
{
    ec_channel channels[3];
    struct stat info;
    ec_error err;
    channels_from(channels, 0);
    const ec_exr_part part = {.name = "", .channels = channels, .channel_count = 3};
    ec_exr_rows *exr;
    ec_png_rows *png;
    remove(ROWS ".exr");
    remove(ROWS ".png");
    CHECK_OK(ec_exr_rows_begin(&exr, ROWS ".exr", W, H, &part, 1, 0, &err), err);
    CHECK_OK(ec_exr_rows_put(exr, &part, 16, &err), err);
    ec_exr_rows_abort(exr);
    CHECK_OK(ec_png_rows_begin(&png, ROWS ".png", &(ec_raster){W, H, 3, 8}, NULL, &err), err);
    CHECK_OK(ec_png_rows_put(png, bytes, 16, &err), err);
    ec_png_rows_abort(png);
    CHECK(stat(ROWS ".exr", &info) != 0 && stat(ROWS ".png", &info) != 0);
    CHECK(ec_png_rows_begin(&png, ROWS ".png", &(ec_raster){0, 5, 3, 8}, NULL, &err) == EC_FAILED && strstr(err.text, "0 x 5"));
    CHECK(ec_exr_rows_begin(&exr, ECLAT_TEST_OUT "/none/rows.exr", W, H, &part, 1, 0, &err) == EC_FAILED && strstr(err.text, "create its folder"));
}

int main(void)
{
    fill();
    exr_rows();
    exr_attributes_of_other_lengths();
    png_rows();
    nothing_half_written();
    TEST_END();
}
