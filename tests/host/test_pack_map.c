/* An environment map's probabilities against those of the definition, written down texel by texel: the same bits, for any
 * number of threads. */
#include <omp.h>

#include "pack/distribution.h"
#include "pack/pack.h"
#include "support/test.h"

static double luminance(const float *rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

static double sine(const ec_environment *e, uint32_t y) { return sin(3.14159265358979323846 * (y + 0.5) / e->height); }

/* [1 6 1] / 8 along each axis: around the map, and no further than the poles. */
static double mean_around(const ec_environment *e, uint32_t x, uint32_t y)
{
    static const double weight[3] = {0.125, 0.75, 0.125};
    double sum = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            int64_t yj = (int64_t)y + j < 0 ? 0 : (int64_t)y + j >= e->height ? e->height - 1 : (int64_t)y + j;
            uint32_t xi = (uint32_t)(((int64_t)x + i + e->width) % e->width);
            sum += weight[i + 1] * weight[j + 1] * luminance(e->rgb + 3 * ((size_t)yj * e->width + xi));
        }
    return sum;
}

typedef struct expected {
    double *weights, *rows, *row_pmf, *pmf, sum, solid, rgb[3];
    ec_distribution_entry *table;
} expected;

static expected expect(const ec_environment *e)
{
    const size_t w = e->width, h = e->height;
    expected x = {malloc(w * h * sizeof(double)), calloc(h, sizeof(double)), calloc(h, sizeof(double)), calloc(w * h, sizeof(double)), 0, 0, {0},
                  calloc(h + w * h, sizeof(ec_distribution_entry))};
    for (size_t i = 0; i < w * h; i++) {
        double s = sine(e, (uint32_t)(i / w));
        x.weights[i] = mean_around(e, (uint32_t)(i % w), (uint32_t)(i / w)) * s;
        x.sum += x.weights[i];
        x.solid += s;
        for (int k = 0; k < 3; k++) x.rgb[k] += s * e->rgb[3 * i + (size_t)k];
    }
    for (size_t i = 0; i < w * h; i++) {
        if (x.weights[i] > 0) x.weights[i] = 0.95 * x.weights[i] / x.sum + 0.05 * sine(e, (uint32_t)(i / w)) / x.solid;
        x.rows[i / w] += x.weights[i];
    }
    if (!(x.sum > 0)) return x;
    ec_distribution_build(x.rows, (uint32_t)h, x.table, x.row_pmf);
    for (size_t y = 0; y < h; y++)
        if (x.rows[y] > 0) ec_distribution_build(x.weights + y * w, (uint32_t)w, x.table + h + y * w, x.pmf + y * w);
    return x;
}

static void check(const ec_environment *e)
{
    const size_t w = e->width, h = e->height;
    expected x = expect(e);
    ec_packed_map map;
    ec_error err;
    size_t wrong = 0;
    CHECK_OK(ec_pack_map(e, &map, &err), err);
    for (size_t i = 0; i < w * h; i++) {
        const float texel[4] = {e->rgb[3 * i], e->rgb[3 * i + 1], e->rgb[3 * i + 2], (float)(x.row_pmf[i / w] * x.pmf[i])};
        wrong += memcmp(map.texels + 4 * i, texel, sizeof texel) != 0;
    }
    CHECK_MSG(!wrong, "%zu x %zu: %zu texels", w, h, wrong);
    CHECK_MSG(map.mean_luminance == x.sum / x.solid, "%zu x %zu: %.17g", w, h, map.mean_luminance);
    for (int k = 0; k < 3; k++) CHECK(map.mean[k] == (float)(x.rgb[k] / x.solid));
    CHECK((map.table != NULL) == (x.sum > 0));
    if (map.table) CHECK_MSG(!memcmp(map.table, x.table, (h + w * h) * sizeof *x.table), "%zu x %zu: the table", w, h);
    ec_packed_map_free(&map);
    free(x.weights);
    free(x.rows);
    free(x.row_pmf);
    free(x.pmf);
    free(x.table);
}

int main(void)
{
    static const uint32_t sizes[][2] = {{1, 1}, {2, 1}, {1, 2}, {3, 3}, {1, 50}, {50, 1}, {37, 19}, {257, 131}, {700, 300}};
    uint32_t noise = 1;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int kind = 0; kind < 3; kind++) { /* all lit; a third black, and a row; all black */
            ec_environment e = {.width = sizes[i][0], .height = sizes[i][1]};
            const size_t values = 3 * (size_t)e.width * e.height;
            e.rgb = malloc(values * sizeof *e.rgb);
            for (size_t k = 0; k < values; k++) {
                noise = noise * 1664525u + 1013904223u;
                bool black = kind == 2 || (kind == 1 && (noise >> 30 == 0 || k / 3 / e.width / 4 == 2));
                e.rgb[k] = black ? 0 : ldexpf((float)(noise >> 8), (int)(noise >> 4 & 15) - 24);
            }
            for (int threads = 1; threads <= 8; threads *= 8) {
                omp_set_num_threads(threads);
                check(&e);
            }
            free(e.rgb);
        }
    TEST_END();
}
