/* tier: quick */
/* Means over squares of an emissive texture, of sizes that are not powers of two and with every wrap mode, against the definition. */
#include "base/luminance.h"
#include "image/image.h"
#include "pack/brightness.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

typedef struct means {
    double mean, square;
} means;

static double texel(const ec_image *image, const ec_texture *t, const float emission[3], int64_t x, int64_t y)
{
    const int64_t w = image->width, h = image->height;
    double rgb[3];
    x = t->wrap_s == EC_WRAP_REPEAT ? (x + w) % w : x < w ? x : w - 1;
    y = t->wrap_t == EC_WRAP_REPEAT ? (y + h) % h : y < h ? y : h - 1;
    for (int k = 0; k < 3; k++) rgb[k] = emission[k] * ec_srgb_bytes()[image->rgba8[4 * (y * w + x) + k]];
    return (float)ec_luminance(rgb);
}

/* The bilinear function between four texels' middles: by Simpson's rule, which is exact for it and for its square. */
static means patch(const ec_image *image, const ec_texture *t, const float emission[3], int64_t x, int64_t y)
{
    static const double weights[3] = {1 / 6.0, 4 / 6.0, 1 / 6.0};
    const double p = texel(image, t, emission, x, y), q = texel(image, t, emission, x + 1, y), r = texel(image, t, emission, x, y + 1),
                 s = texel(image, t, emission, x + 1, y + 1);
    means m = {0};
    if (t->nearest) return (means){p, p * p};
    for (int i = 0; i < 9; i++) {
        const double u = i % 3 / 2.0, v = i / 3 / 2.0, weight = weights[i % 3] * weights[i / 3];
        const double value = (1 - v) * ((1 - u) * p + u * q) + v * ((1 - u) * r + u * s);
        m.mean += weight * value, m.square += weight * value * value;
    }
    return m;
}

static means square(const ec_image *image, const ec_texture *t, const float emission[3], const ec_brightness *b, uint32_t level, uint32_t x, uint32_t y)
{
    means sum = {0};
    int count = 0;
    if (level == 0) return patch(image, t, emission, x, y);
    for (uint32_t j = 2 * y; j < 2 * y + 2 && j < b->rows[level - 1]; j++)
        for (uint32_t i = 2 * x; i < 2 * x + 2 && i < b->columns[level - 1]; i++, count++) {
            const means one = square(image, t, emission, b, level - 1, i, j);
            sum.mean += one.mean, sum.square += one.square;
        }
    return (means){sum.mean / count, sum.square / count};
}

/* Values of a level that differ from the definition. */
static uint32_t wrong_squares(const ec_image *image, const ec_texture *t, const float emission[3], const ec_brightness *b, uint32_t level)
{
    uint32_t wrong = 0;
    for (uint32_t y = 0; y < b->rows[level]; y++)
        for (uint32_t x = 0; x < b->columns[level]; x++) {
            const means m = square(image, t, emission, b, level, x, y);
            const ec_bright one = b->levels[level][(size_t)y * b->columns[level] + x];
            wrong += fabs((double)one.mean - m.mean) > 1e-5 * m.mean || fabs((double)one.square - m.square) > 1e-5 * m.square;
        }
    return wrong;
}

/* has_16_bits: the same values in 16 bits. */
static void check(uint32_t width, uint32_t height, ec_wrap wrap, bool nearest, bool has_16_bits)
{
    const size_t count = 4 * (size_t)width * height;
    const ec_image image = {.width = width, .height = height, .rgba8 = malloc(count)};
    ec_image stored = image;
    ec_texture texture = {.image = 0, .wrap_s = wrap, .wrap_t = wrap, .nearest = nearest};
    ec_material material = {.emission = {2, 1, 0.5f}};
    material.textures[EC_SLOT_EMISSION].texture = 0;
    const ec_scene scene = {.images = &stored, .image_count = 1, .textures = &texture, .texture_count = 1};
    ec_brightness b;
    ec_error err;
    uint32_t wrong = 0, state = 7;
    for (size_t i = 0; i < count; i++) image.rgba8[i] = (uint8_t)((state = state * 1664525 + 1013904223) >> 24);
    if (has_16_bits) {
        stored.rgba16 = malloc(2 * count), stored.rgba8 = NULL;
        for (size_t i = 0; i < count; i++) stored.rgba16[i] = (uint16_t)(257 * image.rgba8[i]);
    }
    CHECK_OK(ec_brightness_make(&scene, &material, &b, &err), err);
    for (uint32_t level = 0; b.columns[level] > 1 || b.rows[level] > 1;) level++, wrong += wrong_squares(&image, &texture, material.emission, &b, level);
    CHECK_MSG(!wrong, "%u x %u, wrap %d, nearest %d, of 16 bits %d: %u squares are wrong", width, height, (int)wrap, nearest, has_16_bits, wrong);
    ec_brightness_free(&b);
    free(stored.rgba16);
    free(image.rgba8);
}

int main(void)
{
    static const uint32_t sizes[][2] = {{1, 1}, {1, 7}, {7, 1}, {5, 3}, {256, 2}, {257, 3}, {512, 5}, {515, 33}};
    static const ec_wrap wraps[] = {EC_WRAP_REPEAT, EC_WRAP_CLAMP, EC_WRAP_MIRROR};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int k = 0; k < 12; k++) check(sizes[i][0], sizes[i][1], wraps[k / 4], k / 2 % 2, k % 2);
    TEST_END();
}
