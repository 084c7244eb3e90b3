/* tier: quick */
/* Exposure, Khronos PBR Neutral and the sRGB curve; and the PNG that contains the result. */
#include <float.h>
#include <png.h>
#include <stdint.h>

#include "image/error_map.h"
#include "image/image.h"
#include "support/test.h"

static ec_error err;

static double srgb_decode(double s) /* the inverse of IEC 61966-2-1 */
{
    return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
}

static void every_byte_comes_back(void)
{
    for (int i = 0; i < 256; i++) {
        float linear = (float)srgb_decode(i / 255.0), in[3] = {linear, linear / 4, linear * 2};
        uint8_t out[3];
        ec_tonemap_rgb(in, out, 1, 0, EC_TONEMAP_NONE);
        CHECK_MSG(out[0] == i, "%d became %d", i, out[0]);
        ec_tonemap_rgb(in, out, 1, 2, EC_TONEMAP_NONE);
        CHECK_MSG(out[1] == i, "%d became %d at +2 EV", i, out[1]);
        ec_tonemap_rgb(in, out, 1, -1, EC_TONEMAP_NONE);
        CHECK_MSG(out[2] == i, "%d became %d at -1 EV", i, out[2]);
    }
    /* The pieces meet at 0.0031308: byte 10 is on the linear piece, byte 11 on the power's. */
    const float edge[3] = {0.0031308f, 10.49f / 255 / 12.92f, 0.5f};
    uint8_t out[3];
    ec_tonemap_rgb(edge, out, 1, 0, EC_TONEMAP_NONE);
    CHECK(out[0] == 10 && out[1] == 10 && out[2] == 188);
}

static void check_rounding(double x)
{
    const long byte = lrint(255 * ec_srgb_encode(x));
    CHECK_MSG(ec_srgb_round(ec_srgb_get_rounder(), x) == byte, "%.17g became %d, not %ld", x, ec_srgb_round(ec_srgb_get_rounder(), x), byte);
}

/* Also at the border between two bytes, to the last bit. */
static void the_table_rounds_as_the_power_does(void)
{
    for (int i = 0; i <= 1 << 20; i++) check_rounding(i / (double)(1 << 20));
    for (int i = 0; i < 255; i++) {
        double low = 0, high = 1;
        for (double middle = 0.5; middle > low && middle < high; middle = (low + high) / 2)
            *(lrint(255 * ec_srgb_encode(middle)) > i ? &high : &low) = middle;
        check_rounding(low);
        check_rounding(high);
        check_rounding(nextafter(low, 0));
        check_rounding(nextafter(high, 1));
    }
}

static void nothing_strange_gets_out(void)
{
    const float in[] = {NAN, INFINITY, -INFINITY, -1, -FLT_MAX, -0.0f, FLT_MAX, FLT_MAX, FLT_MAX, NAN, 1, 0};
    for (int mapper = 0; mapper < EC_TONEMAP_COUNT; mapper++)
        for (float ev = -2000; ev <= 2000; ev += 500) {
            uint8_t out[12];
            memset(out, 77, sizeof out);
            ec_tonemap_rgb(in, out, 4, ev, (ec_tonemap)mapper);
            for (int i = 0; i < 6; i++) CHECK(out[i] == 0);
            for (int i = 6; i < 9; i++) CHECK(out[i] == (ev >= 0 ? 255 : 0));
            CHECK(out[10] == (ev < 0 ? 0 : ev > 0 || mapper == EC_TONEMAP_NONE ? 255 : out[10]) && (ev == 0 || out[9] == out[11])); /* a curve may mix channels */
        }
}

/* Linear values calculated from the specification's formulas: Ks = 0.76, F90 = 0.04, Kd = 0.15. */
static void neutral_follows_its_specification(void)
{
    static const struct { float in[3]; double out[3]; } rows[] = {
        {{0.5f, 0.5f, 0.5f}, {0.46, 0.46, 0.46}},             /* x > 2 F90: f = F90 */
        {{0.04f, 0.3f, 0.2f}, {0.01, 0.27, 0.17}},            /* f = x - x^2 / (4 F90) = 0.04 - 0.01 */
        {{0.08f, 0.08f, 0.8f}, {0.04, 0.04, 0.76}},           /* both pieces of f agree; p = Ks: not compressed */
        {{1, 1, 1}, {0.869090909, 0.869090909, 0.869090909}}, /* p = .96: pn = 1 - .24^2 / (.96 + 1 - 1.52); grey stays */
        /* p = 4, f = 0: pn = 1 - .0576 / 3.48 = .98344828; g = 1 / (.15 (4 - pn) + 1) = .68848; (1 - g) pn = .306366 */
        {{4, 0, 0}, {0.983448276, 0.306366, 0.306366}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        uint8_t out[3];
        ec_tonemap_rgb(rows[i].in, out, 1, 0, EC_TONEMAP_NEUTRAL);
        for (int c = 0; c < 3; c++) {
            double decoded = srgb_decode(out[c] / 255.0);
            double step = srgb_decode((out[c] + 0.52) / 255.0) - decoded;
            CHECK_MSG(fabs(decoded - rows[i].out[c]) <= step, "row %zu channel %d: %g for %g", i, c, decoded, rows[i].out[c]);
        }
    }
    /* Greys from black to white: never darker for a brighter grey, and 255 only in the limit. */
    uint8_t last = 0, out[3];
    for (float x = 0; x < 100; x = x * 1.02f + 0.001f) {
        const float in[3] = {x, x, x};
        ec_tonemap_rgb(in, out, 1, 0, EC_TONEMAP_NEUTRAL);
        CHECK(out[0] >= last && out[0] == out[1] && out[1] == out[2] && (x > 10 || out[0] < 255));
        last = out[0];
    }
}

static void a_png_holds_the_bytes(void)
{
    const char *path = ECLAT_TEST_OUT "/picture.png";
    enum { W = 7, H = 5 };
    uint8_t rgb[3 * W * H], read[3 * W * H];
    for (int i = 0; i < 3 * W * H; i++) rgb[i] = (uint8_t)(i * 37);
    CHECK_OK(ec_png_write(path, W, H, rgb, &err), err);
    png_image image = {.version = PNG_IMAGE_VERSION};
    CHECK(png_image_begin_read_from_file(&image, path) && image.width == W && image.height == H);
    CHECK(image.format == PNG_FORMAT_RGB && !(image.flags & PNG_IMAGE_FLAG_COLORSPACE_NOT_sRGB));
    CHECK(png_image_finish_read(&image, NULL, read, 0, NULL) && memcmp(read, rgb, sizeof rgb) == 0);
    char bytes[64];
    FILE *file = fopen(path, "rb"); /* signature, IHDR (25 bytes), then the sRGB chunk's length and name */
    CHECK(fread(bytes, 1, sizeof bytes, file) == sizeof bytes && memcmp(bytes + 37, "sRGB", 4) == 0);
    fclose(file);
    CHECK(ec_png_write(path, 0, 5, rgb, &err) == EC_FAILED && strstr(err.text, "0 x 5"));
    CHECK(ec_png_write(path, 3000000, 1, rgb, &err) == EC_FAILED);
    remove(path);
}

/* Lightness (CIE L*) of magma rises evenly (exactly so in CAM02-UCS, which L* follows roughly), which makes errors readable. */
static void magma_is_even(void)
{
    uint8_t rgb[3];
    double before = -1, least = 100, most = 0;
    for (int i = 0; i <= 16; i++) {
        ec_magma(i / 16.0, rgb);
        double linear[3], y, lightness;
        for (int c = 0; c < 3; c++) linear[c] = rgb[c] <= 10 ? rgb[c] / 255.0 / 12.92 : pow((rgb[c] / 255.0 + 0.055) / 1.055, 2.4);
        y = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
        lightness = y > 0.008856 ? 116 * cbrt(y) - 16 : 903.3 * y;
        if (i > 0) least = fmin(least, lightness - before), most = fmax(most, lightness - before);
        before = lightness;
    }
    CHECK_MSG(least > 3 && most < 8 && before > 96, "steps of %.1f to %.1f, up to %.1f", least, most, before);
    ec_magma(NAN, rgb);
    CHECK(rgb[0] == 0 && rgb[2] == 4);
    ec_magma(7, rgb);
    CHECK(rgb[0] == 252 && rgb[1] == 253 && rgb[2] == 191);
}

static void the_error_map_is_logarithmic(void)
{
    const float b[15] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0};
    float a[15];
    uint8_t out[15], expected[3];
    for (int i = 0; i < 15; i++) a[i] = b[i];
    for (int c = 0; c < 3; c++) a[3 + c] += 1.01e-3f, a[6 + c] += 0.0319390042f, a[9 + c] = 3, a[12 + c] = 1e-6f;
    ec_error_map(a, b, 5, out);
    static const double place[5] = {0, 0, 0.5, 1, 0}; /* equal, 0.1 %, 3.2 %, 200 %, 0.01 % */
    for (int p = 0; p < 5; p++) {
        ec_magma(place[p], expected);
        for (int c = 0; c < 3; c++) CHECK_MSG(abs(out[3 * p + c] - expected[c]) <= 3, "pixel %d: %d, expected %d", p, out[3 * p + c], expected[c]);
    }
}

int main(void)
{
    magma_is_even();
    the_error_map_is_logarithmic();
    every_byte_comes_back();
    the_table_rounds_as_the_power_does();
    nothing_strange_gets_out();
    neutral_follows_its_specification();
    a_png_holds_the_bytes();
    TEST_END();
}
