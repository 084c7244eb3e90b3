/* tier: quick */
/* The mean of an emissive texture over a triangle: for coordinates on a single point, the texel there, in every wrap mode; for a triangle
 * over two texels, a value between them. */
#include "image/image.h"
#include "pack/texture_mean.h"
#include "support/test.h"

#include <math.h>

enum { WIDTH = 5, HEIGHT = 3 };

/* The coordinate after glTF's wrap modes. */
static uint32_t column(double u, uint32_t size, ec_wrap wrap)
{
    double x = u;
    if (wrap == EC_WRAP_CLAMP) x = u < 0 ? 0 : u > 1 ? 1 : u;
    if (wrap == EC_WRAP_REPEAT) x = fmod(fmod(u, 1) + 1, 1);
    if (wrap == EC_WRAP_MIRROR) x = fabs(fmod(u, 2)), x = x > 1 ? 2 - x : x;
    const uint32_t i = (uint32_t)floor(x * size);
    return i < size ? i : size - 1;
}

static void mean_of(const float corners[6], ec_wrap wrap_s, ec_wrap wrap_t, double rgb[3])
{
    static uint8_t bytes[4 * WIDTH * HEIGHT];
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++) bytes[i] = (uint8_t)(4 * i + 3);
    ec_image image = {.width = WIDTH, .height = HEIGHT, .rgba8 = bytes};
    ec_texture texture = {.image = 0, .wrap_s = wrap_s, .wrap_t = wrap_t};
    uint32_t indices[3] = {0, 1, 2};
    float uv[6];
    for (int i = 0; i < 6; i++) uv[i] = corners[i];
    const ec_scene scene = {.images = &image, .image_count = 1, .textures = &texture, .texture_count = 1, .uv = {uv}, .indices = indices};
    const ec_texture_use use = {.texture = 0, .transform = {1, 0, 0, 0, 1, 0}};
    ec_texture_triangle_mean(&scene, &use, 0, rgb);
}

static double stored(uint32_t x, uint32_t y, int k) { return ec_srgb_bytes()[(uint8_t)(4 * (4 * (y * WIDTH + x) + (uint32_t)k) + 3)]; }

int main(void)
{
    static const double places[] = {0, 0.1, 0.39, 0.5, 0.62, 0.99, 1.1, 1.7, 2.3, 3.9, -0.1, -0.7, -1.3, -2.63};
    enum { PLACES = sizeof places / sizeof *places };
    for (int i = 0; i < PLACES * PLACES; i++)
        for (int modes = 0; modes < 9; modes++) {
            const double u = places[i % PLACES], v = places[i / PLACES];
            const float point[6] = {(float)u, (float)v, (float)u, (float)v, (float)u, (float)v};
            const ec_wrap s = (ec_wrap)(modes % 3), t = (ec_wrap)(modes / 3);
            double rgb[3];
            mean_of(point, s, t, rgb);
            for (int k = 0; k < 3; k++) {
                const double expected = stored(column(u, WIDTH, s), column(v, HEIGHT, t), k);
                CHECK_MSG(fabs(rgb[k] - expected) < 1e-12, "(%g, %g), wrap %d and %d: channel %d is %g, not %g", u, v, (int)s, (int)t, k, rgb[k], expected);
            }
        }
    double rgb[3];
    mean_of((float[6]){NAN, INFINITY, NAN, INFINITY, NAN, INFINITY}, EC_WRAP_REPEAT, EC_WRAP_CLAMP, rgb);
    CHECK_MSG(fabs(rgb[0] - stored(0, 0, 0)) < 1e-12, "coordinates that are no numbers: %g", rgb[0]);
    mean_of((float[6]){0.05f, 0.1f, 0.35f, 0.1f, 0.05f, 0.1f}, EC_WRAP_REPEAT, EC_WRAP_REPEAT, rgb);
    CHECK_MSG(rgb[1] > stored(0, 0, 1) && rgb[1] < stored(1, 0, 1), "over two texels: %g, of %g and %g", rgb[1], stored(0, 0, 1), stored(1, 0, 1));
    TEST_END();
}
