/* tiers: quick, long */
/* Texture look-ups against double precision: wrap modes, nearest and bilinear, sRGB, float texels, uv transforms. */
#include "kernel/kernel_reference.h"
#include "image/image.h"
#include "pack/pack.h"

typedef struct image {
    uint32_t width, height, wrap_s, wrap_t;
    bool nearest, is_float;
    uint32_t offset;
} image;

static image images[24];
static uint32_t image_count;
static ec_texture_data table[24];
static uint32_t texels[32768], texel_words;
static float srgb[256], out[4 * N], u[N], v[N];
static uint32_t on[N];
static int32_t id[N];

static void add_image(uint32_t width, uint32_t height, uint32_t wrap_s, uint32_t wrap_t, bool nearest, bool is_float)
{
    images[image_count] = (image){width, height, wrap_s, wrap_t, nearest, is_float, texel_words};
    table[image_count++] = (ec_texture_data){texel_words, width, height, wrap_s | wrap_t << EC_TEXTURE_WRAP_T |
                                             (nearest ? EC_TEXTURE_NEAREST : 0) | (is_float ? EC_TEXTURE_FLOAT : 0)};
    for (uint32_t i = 0; i < width * height * (is_float ? 4 : 1); i++) {
        float value = random_float(0, 20);
        uint32_t word = (uint32_t)test_random_u64();
        if (is_float) memcpy(&word, &value, sizeof word);
        texels[texel_words++] = word;
    }
}

static void make_images(void)
{
    for (uint32_t s = 0; s < 3; s++)
        for (uint32_t t = 0; t < 3; t++) add_image(s + 5, 2 * t + 3, s, t, false, t == 1);
    for (uint32_t s = 0; s < 3; s++) add_image(7, 4, s, (s + 1) % 3, true, s == 1);
    add_image(1, 1, 0, 0, false, false);
    add_image(1, 5, 2, 1, false, false);
    add_image(64, 128, 0, 0, false, false);
    for (uint32_t s = 0; s < 3; s++) add_image(2, 2, s, s, false, false); /* across the seam is the previous texel */
    for (int i = 0; i < 256; i++) srgb[i] = (float)ec_srgb_to_linear(i / 255.0);
}

/* IEC 61966-2-1, from its text and not from the host's code. */
static double decode(double c) { return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4); }

/* Texel `i` of an infinite, wrapped row: glTF's samplers are OpenGL's (4.6, table 8.20). */
static int64_t wrapped(int64_t i, int64_t size, uint32_t wrap)
{
    if (wrap == 1) return i < 0 ? 0 : (i >= size ? size - 1 : i);
    if (wrap == 0) return ((i % size) + size) % size;
    int64_t m = ((i % (2 * size)) + 2 * size) % (2 * size);
    return m < size ? m : 2 * size - 1 - m;
}

static void texel(const image *im, int64_t x, int64_t y, bool is_srgb, double *rgba)
{
    uint64_t at = (uint64_t)(wrapped(y, im->height, im->wrap_t) * im->width + wrapped(x, im->width, im->wrap_s));
    for (int k = 0; k < 4; k++) {
        if (im->is_float) {
            float f;
            memcpy(&f, &texels[im->offset + 4 * at + (uint64_t)k], sizeof f);
            rgba[k] = f;
        } else {
            double c = (texels[im->offset + at] >> (8 * k) & 255) / 255.0;
            rgba[k] = is_srgb && k < 3 ? decode(c) : c;
        }
    }
}

/* least, most: range of the look-up if its coordinates are off by `slack` texels. */
static void reference(const image *im, double uu, double vv, bool is_srgb, double slack, double *least, double *most)
{
    for (int k = 0; k < 4; k++) least[k] = 1e300, most[k] = -1e300;
    for (int corner = 0; corner < 5; corner++) {
        double x = uu * im->width, y = vv * im->height, rgba[4] = {0};
        if (corner) x += corner & 1 ? slack : -slack, y += corner & 2 ? slack : -slack;
        if (im->nearest) {
            texel(im, (int64_t)floor(x), (int64_t)floor(y), is_srgb, rgba);
        } else {
            x -= 0.5, y -= 0.5;
            double fx = x - floor(x), fy = y - floor(y);
            for (int q = 0; q < 4; q++) {
                double part[4], w = (q & 1 ? fx : 1 - fx) * (q & 2 ? fy : 1 - fy);
                texel(im, (int64_t)floor(x) + (q & 1), (int64_t)floor(y) + (q >> 1), is_srgb, part);
                for (int k = 0; k < 4; k++) rgba[k] += w * part[k];
            }
        }
        for (int k = 0; k < 4; k++) least[k] = fmin(least[k], rgba[k]), most[k] = fmax(most[k], rgba[k]);
    }
}

static void compare(const image *im, uint32_t i, double uu, double vv, double slack, bool is_srgb)
{
    double least[4], most[4];
    reference(im, uu, vv, is_srgb, slack, least, most);
    for (uint32_t k = 0; k < 4; k++) {
        double got = out[k * N + i], margin = 8 * U * (1 + fabs(most[k])) + 2 * slack * (im->is_float ? 20 : 1);
        CHECK_MSG(got >= least[k] - margin && got <= most[k] + margin,
                  "%ux%u wrap %u %u%s%s%s at (%.9g, %.9g), channel %u: %.9g, not %.9g", im->width, im->height, im->wrap_s, im->wrap_t,
                  im->nearest ? " nearest" : "", im->is_float ? " float" : "", is_srgb ? " sRGB" : "", uu, vv, k, got, (least[k] + most[k]) / 2);
    }
}

static void make_coordinates(void)
{
    for (uint32_t i = 0; i < N; i++) {
        const image *im = &images[i % image_count];
        id[i] = (int32_t)(i % image_count);
        on[i] = i % 13 != 0;
        u[i] = random_float(-3, 4);
        v[i] = random_float(-3, 4);
        if (i % 3 == 1) { /* centres of texels, where nothing is interpolated */
            u[i] = ((float)(test_random_u64() % (4 * im->width)) + 0.5f) / (float)im->width - 2;
            v[i] = ((float)(test_random_u64() % (4 * im->height)) + 0.5f) / (float)im->height - 2;
        }
        if (i % 17 == 0) u[i] = (float)(i / 17 % 5) - 2; /* seams */
        if (i % 19 == 0) v[i] = nextafterf((float)(i / 19 % 5) - 2, -10);
        if (!on[i]) id[i] = -1;
    }
}

static void look_ups_are_right(bool is_srgb)
{
    uint32_t flag = is_srgb;
    make_coordinates();
    if (!RUN_ALL("sample", 9, SCALAR(n), SCALAR(flag), IN(id, N), IN(u, N), IN(v, N), IN(on, N), IN(table, 24), IN(texels, 32768),
                 IN(srgb, 256), OUT(out, 4 * N)))
        return;
    for (uint32_t i = 0; i < N && test_failures < 8; i++) {
        if (!on[i]) {
            for (uint32_t k = 0; k < 4; k++) CHECK(out[k * N + i] == 1.0f); /* white where there is no texture */
            continue;
        }
        const image *im = &images[i % image_count];
        compare(im, i, u[i], v[i], 8 * U * (im->width > im->height ? im->width : im->height), is_srgb);
    }
}

/* Every byte, at the centre of a texel, gives its exact linear value, rounded to float. */
static void srgb_is_exact(void)
{
    for (uint32_t i = 0; i < 256; i++) texels[images[14].offset + i] = i * 0x01010101u;
    for (uint32_t i = 0; i < N; i++) {
        id[i] = 14;
        on[i] = 1;
        u[i] = ((float)(i % 64) + 0.5f) / 64;
        v[i] = ((float)(i / 64 % 4) + 0.5f) / 128;
    }
    const uint32_t yes = 1;
    if (!RUN_ALL("sample", 9, SCALAR(n), SCALAR(yes), IN(id, N), IN(u, N), IN(v, N), IN(on, N), IN(table, 24), IN(texels, 32768),
                 IN(srgb, 256), OUT(out, 4 * N)))
        return;
    CHECK(out[255] == 1.0f && out[3 * N + 255] == 1.0f);
    for (uint32_t i = 0; i < 256; i++) {
        CHECK_MSG(out[i] == (float)decode(i / 255.0), "sRGB byte %u: %.9g, not %.9g", i, (double)out[i], decode(i / 255.0));
        CHECK_MSG(fabs(out[3 * N + i] - i / 255.0) <= 2 * U, "alpha byte %u: %.9g", i, (double)out[3 * N + i]);
    }
}

/* uv sets, transforms and factors of a material, interpolated over a triangle. */
static void materials_are_looked_up(void)
{
    static ec_material_data materials[3];
    static ec_prim prims[6];
    static float uvs[4 * 18], b1[N], b2[N];
    static uint32_t indices[3 * 6 + 4], prim[N];
    for (int m = 0; m < 3; m++) {
        ec_texture_slot *slot = &materials[m].slots[EC_SLOT_BASE_COLOR];
        for (int k = 0; k < 4; k++) materials[m].base_color[k] = random_float(0.2, 1);
        *slot = (ec_texture_slot){m < 2 ? m * 4 : -1, (uint32_t)m & 1, {0}};
        for (int k = 0; k < 6; k++) slot->transform[k] = random_float(-2, 2);
    }
    for (uint32_t p = 0; p < 6; p++) {
        prims[p].material = p % 3;
        for (uint32_t k = 0; k < 3; k++) indices[3 * p + k] = 17 - 3 * p - k; /* reversed */
    }
    for (int i = 0; i < 4 * 18; i++) uvs[i] = random_float(-2, 2);
    for (uint32_t i = 0; i < N; i++) {
        prim[i] = i % 6;
        b1[i] = random_float(0, 1);
        b2[i] = random_float(0, 1 - b1[i]);
    }
    if (!RUN_ALL("look_up", 11, SCALAR(n), IN(prim, N), IN(b1, N), IN(b2, N), IN(prims, 6), IN(indices, 22), IN(uvs, 72), IN(materials, 3),
                 IN(table, 24), IN(texels, 32768), IN(srgb, 256), OUT(out, 4 * N)))
        return;
    for (uint32_t i = 0; i < N && test_failures < 8; i++) {
        const ec_material_data *m = &materials[prim[i] % 3];
        const ec_texture_slot *slot = &m->slots[EC_SLOT_BASE_COLOR];
        double b[3] = {1.0 - b1[i] - b2[i], b1[i], b2[i]}, uv[2] = {0};
        for (uint32_t k = 0; k < 3; k++)
            for (uint32_t c = 0; c < 2; c++) uv[c] += b[k] * uvs[4 * indices[3 * prim[i] + k] + 2 * slot->uv_set + c];
        const float *t = slot->transform;
        double tu = t[0] * uv[0] + t[1] * uv[1] + t[2], tv = t[3] * uv[0] + t[4] * uv[1] + t[5];
        for (uint32_t k = 0; k < 4; k++) out[k * N + i] /= m->base_color[k];
        if (slot->texture < 0) for (uint32_t k = 0; k < 4; k++) CHECK_NEAR(out[k * N + i], 1.0, 2 * U);
        else compare(&images[slot->texture], i, tu, tv, 200 * U, true);
    }
}

/* For all coordinates, including NaN and infinity, the texels are inside the image. */
static void no_coordinate_leaves_the_image(void)
{
    static const float special[8] = {NAN, INFINITY, -INFINITY, 3e38f, -3e38f, 1e10f, -1e-30f, 16777216.0f};
    static uint32_t size[N], wrap[N], nearest[N], first[N], second[N];
    static float weight[N];
    for (uint32_t i = 0; i < N; i++) {
        u[i] = i % 2 ? special[i / 2 % 8] : (float)(test_random_in(-1, 1) * pow(10, test_random_in(-40, 38)));
        size[i] = 1 + (uint32_t)(test_random_u64() % (i % 3 ? 8 : 16384));
        wrap[i] = (uint32_t)(test_random_u64() % 3);
        nearest[i] = i / 48 % 2;
    }
    if (!RUN_ALL("axis", 4, IN(u, N), IN(size, N), IN(wrap, N), IN(nearest, N), OUT(first, N), OUT(second, N), OUT(weight, N))) return;
    uint32_t wrong = 0, finite = 0;
    for (uint32_t i = 0; i < N; i++) {
        if (first[i] < size[i] && second[i] < size[i]) continue;
        finite += isfinite(u[i]);
        if (!wrong++) fprintf(stderr, "u %g size %u wrap %u: texels %u and %u\n", (double)u[i], size[i], wrap[i], first[i], second[i]);
    }
    CHECK_MSG(wrong == 0, "%u coordinates (%u of them finite) lead out of the image", wrong, finite);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    for (int i = 0; i < kernel_widths(&cl); i++)
        programs[i] = kernel_build(&cl, "texture", lane_widths[i], "-DFEATURES=(EC_FEATURE_BASE_COLOR_TEXTURE+EC_FEATURE_FLOAT_TEXTURE)");
    if (!test_failures) {
        make_images();
        look_ups_are_right(false);
        look_ups_are_right(true);
        materials_are_looked_up();
        srgb_is_exact();
        no_coordinate_leaves_the_image();
    }
    for (int i = 0; i < kernel_widths(&cl); i++)
        if (programs[i]) clReleaseProgram(programs[i]);
    ec_cl_close(&cl);
    TEST_END();
}
