/* tier: quick */
/* An environment map's probabilities against the definition, patch by patch; and equal bytes for any number of threads. */
#include <omp.h>

#include "pack/pack.h"
#include "support/test.h"

static double luminance(const float *rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

static double sine(const ec_environment *e, uint32_t y) { return sin(3.14159265358979323846 * (y + 0.5) / e->height); }

/* Centres of the rows that bound a row of patches, in texels from the upper pole; the poles themselves bound the first and the last. */
static double edge(const ec_environment *e, int64_t y) { return y < 0 ? 0 : y >= (int64_t)e->height ? e->height : y + 0.5; }

/* Integral over a patch of the interpolated luminance times a sine that is linear between the edges, by Simpson's rule: exact for a
 * polynomial of degree two. */
static double integral(const ec_environment *e, uint32_t x, uint32_t y)
{
    static const double weight[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
    const double top = edge(e, (int64_t)y - 1), bottom = edge(e, y);
    const double sines[2] = {y ? sin(3.14159265358979323846 * top / e->height) : 0,
                             y < e->height ? sin(3.14159265358979323846 * bottom / e->height) : 0};
    double mean[2] = {0, 0}, sum = 0; /* luminance along either edge */
    for (int k = 0; k < 4; k++) {
        const uint32_t row = k < 2 ? (y ? y - 1 : 0) : (y < e->height ? y : y - 1), column = (x + (k & 1)) % e->width;
        mean[k / 2] += 0.5 * luminance(e->rgb + 3 * ((size_t)row * e->width + column));
    }
    for (int k = 0; k < 3; k++)
        sum += weight[k] * (mean[0] + (mean[1] - mean[0]) * k / 2) * (sines[0] + (sines[1] - sines[0]) * k / 2);
    return sum * (bottom - top);
}

static uint64_t share(const ec_distribution_entry *table, uint32_t n, uint32_t i)
{
    return (uint32_t)((i + 1 < n ? table[i + 1].first : 0) - table[i].first) + ((uint64_t)(n == 1) << 32);
}

/* A patch's scale is its probability over its integral, per solid angle: of 2 pi^2 over as many texels. Where all texels are positive it is
 * one number for the whole map, except for rounding of shares to whole numbers. */
static void check(const ec_environment *e)
{
    const uint32_t w = e->width, h = e->height;
    ec_packed_map map;
    ec_error err;
    uint64_t wrong = 0, off = 0, lost = 0;
    double sum = 0, solid = 0, rgb[3] = {0};
    CHECK_OK(ec_pack_map(e, &map, &err), err);
    for (uint32_t y = 0; y <= h; y++)
        for (uint32_t x = 0; x < w; x++) sum += integral(e, x, y);
    for (uint32_t i = 0; i < w * h; i++) {
        solid += sine(e, i / w);
        for (int k = 0; k < 3; k++) rgb[k] += sine(e, i / w) * e->rgb[3 * (size_t)i + (size_t)k];
    }
    for (uint32_t y = 0; y <= h; y++) {
        const double row = map.table ? (double)share(map.table, h + 1, y) * 0x1p-32 : 0;
        const ec_distribution_entry *patches = map.table ? map.table + h + 1 + (size_t)y * w : NULL;
        double of_row = 0;
        for (uint32_t x = 0; x < w; x++) of_row += integral(e, x, y);
        off += map.table && fabs(row - of_row / sum) > (h + 2) * 0x1p-32;
        for (uint32_t x = 0; x < w; x++) {
            const float *texel = map.texels + 4 * ((size_t)y * w + x);
            const double want = integral(e, x, y), pmf = row > 0 ? row * (double)share(patches, w, x) * 0x1p-32 : 0;
            wrong += memcmp(texel, e->rgb + 3 * ((size_t)(y ? y - 1 : 0) * w + x), 3 * sizeof *texel) != 0;
            lost += (pmf > 0) != (want > 0);
            off += want > 0 && fabs(pmf / row - want / of_row) > (w + 1) * 0x1p-32;
            off += want > 0 ? !(fabs(texel[3] / (pmf / want * w * h / (2 * pow(3.14159265358979323846, 2))) - 1) < 1e-6) : texel[3] != 0;
        }
    }
    CHECK_MSG(!wrong && !lost && !off, "%u x %u: %llu texels, %llu patches without a chance or with one for nothing, %llu of another",
              w, h, (unsigned long long)wrong, (unsigned long long)lost, (unsigned long long)off);
    CHECK_MSG(fabs(map.mean_luminance - sum / solid) <= 1e-12 * sum / solid, "%u x %u: %.17g", w, h, map.mean_luminance);
    for (int k = 0; k < 3; k++) CHECK(map.mean[k] == (float)(rgb[k] / solid));
    CHECK((map.table != NULL) == (sum > 0));
    ec_packed_map_free(&map);
}

/* The bytes are the same for one thread and for eight. */
static void check_threads(const ec_environment *e)
{
    ec_packed_map maps[2];
    ec_error err;
    const size_t count = (size_t)e->width * (e->height + 1);
    for (int i = 0; i < 2; i++) {
        omp_set_num_threads(i ? 8 : 1);
        CHECK_OK(ec_pack_map(e, &maps[i], &err), err);
    }
    CHECK(!memcmp(maps[0].texels, maps[1].texels, 4 * count * sizeof(float)));
    if (maps[0].table) CHECK(!memcmp(maps[0].table, maps[1].table, (count + e->height + 1) * sizeof *maps[0].table));
    for (int i = 0; i < 2; i++) ec_packed_map_free(&maps[i]);
}

int main(void)
{
    static const uint32_t sizes[][2] = {{1, 1}, {2, 1}, {1, 2}, {3, 3}, {1, 50}, {50, 1}, {37, 19}, {257, 131}, {700, 300}};
    uint32_t noise = 1;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int kind = 0; kind < 3; kind++) { /* all lit; a third and a row black; all black */
            ec_environment e = {.width = sizes[i][0], .height = sizes[i][1]};
            const size_t values = 3 * (size_t)e.width * e.height;
            e.rgb = malloc(values * sizeof *e.rgb);
            for (size_t k = 0; k < values; k++) {
                noise = noise * 1664525u + 1013904223u;
                bool black = kind == 2 || (kind == 1 && (noise >> 30 == 0 || k / 3 / e.width / 4 == 2));
                e.rgb[k] = black ? 0 : ldexpf((float)(noise >> 8), (int)(noise >> 4 & 15) - 24);
            }
            check(&e);
            check_threads(&e);
            free(e.rgb);
        }
    TEST_END();
}
