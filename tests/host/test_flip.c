/* tier: quick */
/* FLIP and SSIM against values of PyPI's flip-evaluator 1.7 and scikit-image 0.26 (gaussian_weights, sigma 1.5, use_sample_covariance=False) on luma. */
#include "image/flip.h"
#include "support/test.h"

enum { W = 48, H = 40, PIXELS = W * H };

static int byte_of(int x, int y, int c, int is_changed)
{
    int v = (x * (3 + c) + y * (5 - c) * 2 + (x / 8 + y / 8) % 2 * 90) % 256;
    if (is_changed && (x / 12 + y / 10) % 3 == 0) v = v * (14 + c) / 16;
    return is_changed && x == 30 && y == 20 ? 255 : v;
}

static void make(float *rgb, int is_changed)
{
    for (int i = 0; i < 3 * PIXELS; i++) rgb[i] = (float)byte_of(i / 3 % W, i / 3 / W, i % 3, is_changed) / 255;
}

static double mean_of(const float *map)
{
    double sum = 0;
    for (int p = 0; p < PIXELS; p++) sum += map[p];
    return sum / PIXELS;
}

int main(void)
{
    static float a[3 * PIXELS], b[3 * PIXELS], map[PIXELS];
    static uint8_t mask[PIXELS];
    static const struct { int x, y; double flip; } known[] = {{0, 0, 0.0239736}, {5, 3, 0.17837377}, {13, 12, 0.01931955}, {30, 20, 0.43522978},
                                                              {31, 21, 0.2773446}, {47, 39, 0.20168625}, {36, 5, 0.22714357}};
    ec_error err;
    make(a, 1);
    make(b, 0);
    CHECK_OK(ec_flip(a, b, W, H, map, &err), err);
    CHECK_NEAR(mean_of(map), 0.13183793, 1e-4);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) CHECK_NEAR(map[known[i].y * W + known[i].x], known[i].flip, 1e-3);
    CHECK_NEAR(ec_ssim(a, b, W, H, NULL), 0.98931904, 1e-6);

    CHECK_OK(ec_flip(b, b, W, H, map, &err), err);
    CHECK(mean_of(map) == 0);
    CHECK_NEAR(ec_ssim(b, b, W, H, NULL), 1, 1e-12);
    for (int i = 0; i < 3 * PIXELS; i++) a[i] = 1, b[i] = 0;
    CHECK_OK(ec_flip(a, b, W, H, map, &err), err);
    CHECK(map[0] > 0.9f && map[0] <= 1);

    CHECK(isnan(ec_ssim(a, b, W, H, mask)));
    CHECK(isnan(ec_ssim(a, b, 10, 40, NULL)));
    TEST_END();
}
