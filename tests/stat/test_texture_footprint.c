/* tier: quick */
/* Textures have no footprint: a look-up is bilinear or nearest at full resolution, and pixels are supersampled. So a picture converges to
 * the texture's mean over a pixel, at any scale, and a file's minification filter and mipmaps change no bit. */
#include "image/image.h"
#include "support/gltf_writer.h"
#include "support/render_case.h"

enum { SIDE = 400, PIXELS = 4, OF_PIXEL = SIDE / PIXELS }; /* each pixel has 100 x 100 texels */

/* A checkerboard with squares of one texel, noise in it, and brighter to the right. */
static uint8_t *texels(void)
{
    uint8_t *rgb = malloc(3 * SIDE * SIDE);
    uint32_t state = 3;
    for (int i = 0; rgb && i < 3 * SIDE * SIDE; i++) {
        int x = i / 3 % SIDE, y = i / 3 / SIDE;
        state = state * 1664525u + 1013904223u;
        rgb[i] = (uint8_t)((x + y) % 2 * 120 + x / 8 + (int)(state >> 24) / 4);
    }
    return rgb;
}

/* Weight of texel `at` in pixel `pixel` along one axis. A bilinear look-up spreads a texel over its neighbours, 1/8 of it beyond each edge. */
static double share(int at, int pixel, bool nearest)
{
    int first = pixel * OF_PIXEL, last = first + OF_PIXEL - 1, before = (first + SIDE - 1) % SIDE, after = (last + 1) % SIDE;
    if (nearest) return at >= first && at <= last;
    if (at == before || at == after) return 0.125;
    return at < first || at > last ? 0 : at == first || at == last ? 0.875 : 1;
}

/* Mean of the linear radiance, not of its sRGB code. */
static double mean_of(const uint8_t *rgb, int px, int py, int channel, bool nearest)
{
    double sum = 0;
    for (int y = 0; y < SIDE; y++) {
        double row = share(y, py, nearest);
        for (int x = 0; row > 0 && x < SIDE; x++) sum += row * share(x, px, nearest) * ec_srgb_to_linear(rgb[3 * (y * SIDE + x) + channel] / 255.0);
    }
    return sum / OF_PIXEL / OF_PIXEL;
}

/* An unlit square that fills the picture exactly; v runs down. */
static case_image show(const uint8_t *rgb, const char *sampler)
{
    gltf_writer *w = gltf_new();
    ec_error err = {0};
    gltf_add(&w->samplers, "{%s}", sampler);
    gltf_add(&w->textures, "{\"source\":0,\"sampler\":0}");
    int material = gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}},\"doubleSided\":true,"
                                           "\"extensions\":{\"KHR_materials_unlit\":{}}}");
    gltf_quad(w, material, (double[3]){-1, 1, 0}, (double[3]){2, 0, 0}, (double[3]){0, -2, 0});
    gltf_add(&w->cameras, "{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":1,\"ymag\":1,\"znear\":0.1,\"zfar\":10}}");
    gltf_node_looking(w, (double[3]){0, 0, 3}, (double[3]){0, 0, -1}, "\"camera\":0");
    CHECK_OK(ec_png_write(ECLAT_TEST_OUT "/footprint-0.png", SIDE, SIDE, rgb, &err), err);
    ec_render_options o = case_options(PIXELS, PIXELS, 16384);
    o.max_depth = 1;
    case_image image = case_render_file(gltf_write(w, "footprint"), "0,0,0", &o);
    free(w);
    return image;
}

/* 48 values in 2 pictures, each from 16 batches: one of them exceeds 6 standard errors 1 time in 500. */
static void check(const case_image *image, const uint8_t *rgb, bool nearest)
{
    double worst = 0, noise = 0;
    for (int i = 0; i < 3 * PIXELS * PIXELS; i++) {
        double expected = mean_of(rgb, i / 3 % PIXELS, i / 3 / PIXELS, i % 3, nearest), off = fabs(image->rgb[i] - expected);
        CHECK_MSG(off <= 6 * image->se[i] + 2e-6 && image->se[i] < 0.01 * expected, "%s, pixel %d: %.6f +- %.6f, expected %.6f",
                  nearest ? "nearest" : "bilinear", i / 3, image->rgb[i], image->se[i], expected);
        worst = fmax(worst, off / expected);
        noise = fmax(noise, image->se[i] / expected);
    }
    printf("%s: off by at most %.2g of the mean of 10 000 texels, noise up to %.2g\n", nearest ? "nearest" : "bilinear", worst, noise);
}

int main(void)
{
    static const int filters[] = {9728, 9729, 9984, 9985, 9986, 9987};
    uint8_t *rgb = texels();
    case_image plain = show(rgb, "\"magFilter\":9729"), nearest = show(rgb, "\"magFilter\":9728");
    check(&plain, rgb, false);
    check(&nearest, rgb, true);
    CHECK(!case_same_bits(&plain.film, &nearest.film));
    for (size_t i = 0; i < sizeof filters / sizeof *filters; i++) {
        char sampler[64];
        snprintf(sampler, sizeof sampler, "\"magFilter\":9729,\"minFilter\":%d", filters[i]);
        case_image other = show(rgb, sampler);
        CHECK_MSG(case_same_bits(&plain.film, &other.film), "minFilter %d changes the picture", filters[i]);
        case_free(&other);
    }
    case_free(&plain);
    case_free(&nearest);
    free(rgb);
    TEST_END();
}
