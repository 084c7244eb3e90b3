/* tier: quick */
/* A pass of the à-trous filter against one in double, over a picture of noise, edges of albedo, normal and depth, and a pixel near float's
 * maximum. A weight is a product of numbers from 0 to 1, each 1 minus a quotient with at most 12 roundings; a sum has 25 of them. Also the
 * filter's purpose: a uniform picture stays, nothing crosses an edge, the variance falls. */
#include "denoise/atrous.h"
#include "kernel/kernel_run.h"
#include "support/films.h"
#include "shared/path_state.h"

enum { WIDTH = 29, HEIGHT = 21, PIXELS = WIDTH * HEIGHT };
#define ROUNDINGS 128

static float from[4 * PIXELS], to[4 * PIXELS], features[EC_AOV_FIELDS * PIXELS];

static double luminance(const float *c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }
static int within(int x, int size) { return x < 0 ? 0 : x >= size ? size - 1 : x; }
static const float *feature(int x, int y) { return features + EC_AOV_FIELDS * (within(y, HEIGHT) * WIDTH + within(x, WIDTH)); }
static const float *pixel(int x, int y) { return from + 4 * (within(y, HEIGHT) * WIDTH + within(x, WIDTH)); }

static double biweight(double square, double spread)
{
    const double t = fmax(1 - square / spread, 0);
    return t * t;
}

static double square_between(const float *a, const float *b)
{
    double sum = 0;
    for (int c = 0; c < 3; c++) sum += ((double)a[c] - b[c]) * ((double)a[c] - b[c]);
    return sum;
}

static double weight_of(int x, int y, int dx, int dy, int apart)
{
    static const double tap[] = {0.375, 0.25, 0.0625};
    const float *own = feature(x, y), *other = feature(x + dx * apart, y + dy * apart);
    double variance = 0, weight = tap[abs(dx)] * tap[abs(dy)];
    if (!dx && !dy) return weight;
    for (int v = -1; v <= 1; v++)
        for (int u = -1; u <= 1; u++) variance += (u ? 0.25 : 0.5) * (v ? 0.25 : 0.5) * (double)pixel(x + u, y + v)[3];
    const double brighter = luminance(pixel(x + dx * apart, y + dy * apart)) - luminance(pixel(x, y)), deeper = (double)other[6] - own[6];
    const double slope = 0.5 * fmax(fabs((double)feature(x - 1, y)[6] - feature(x + 1, y)[6]), fabs((double)feature(x, y - 1)[6] - feature(x, y + 1)[6]));
    return weight * biweight(brighter * brighter, 64 * variance + 1e-30) * biweight(square_between(own + 3, other + 3), 1.0 / 16) *
           biweight(square_between(own, other), 1.0 / 16) *
           biweight(deeper * deeper, 9 * slope * slope * (dx * dx + dy * dy) * apart * apart + 1e-6 * own[6] * (double)own[6] + 1e-30);
}

static void check_pixel(int x, int y, int apart)
{
    double sum[4] = {0}, most = 0, weights = 0;
    for (int dy = -2; dy <= 2; dy++)
        for (int dx = -2; dx <= 2; dx++) {
            const double w = weight_of(x, y, dx, dy, apart);
            const float *p = pixel(x + dx * apart, y + dy * apart);
            for (int c = 0; c < 3; c++) sum[c] += w * (double)p[c], most = fmax(most, w > 0 ? (double)p[c] : 0);
            sum[3] += w * w * (double)p[3];
            weights += w;
        }
    const float *out = to + 4 * (y * WIDTH + x);
    for (int c = 0; c < 3; c++) CHECK_NEAR(out[c], sum[c] / weights, ROUNDINGS * 0x1p-24 * most);
    CHECK_NEAR(out[3], sum[3] / (weights * weights), ROUNDINGS * 0x1p-23 * sum[3] / (weights * weights));
}

/* Noise about 1 on the left of a checkerboard's line and about 4 on its right: four areas by albedo, normal and depth. */
static void make(double noise)
{
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % WIDTH, y = i / WIDTH, is_right = x >= WIDTH / 2, is_low = y >= HEIGHT / 2;
        float *f = features + EC_AOV_FIELDS * i;
        memset(f, 0, EC_AOV_FIELDS * sizeof *f);
        f[is_right] = 0.8f;
        f[3 + is_low] = 1;
        f[6] = (float)(5 + 0.1 * x + (is_right && is_low ? 3 : 0));
        for (int c = 0; c < 3; c++) from[4 * i + c] = (float)((is_right ? 4 : 1) + noise * (test_random() - 0.5));
        from[4 * i + 3] = (float)(noise * noise / 12);
    }
    from[4 * 100] *= noise > 0 ? 1e6f : 1;
}

static bool run(ec_cl *cl, cl_program program, int apart)
{
    const int width = WIDTH, height = HEIGHT;
    const kernel_array arrays[] = {IN(from, 4 * PIXELS), IN(features, EC_AOV_FIELDS * PIXELS), OUT(to, 4 * PIXELS), SCALAR(width), SCALAR(height), SCALAR(apart)};
    return kernel_call(cl, program, "ec_atrous", (PIXELS + 63) / 64 * 64, 64, arrays, sizeof arrays / sizeof *arrays);
}

static void check_purpose(ec_cl *cl, cl_program program)
{
    double before = 0, after = 0;
    make(0);
    if (!run(cl, program, 2)) return;
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++) CHECK_NEAR(to[4 * i + c], i % WIDTH >= WIDTH / 2 ? 4 : 1, 1e-5);
    make(0.5);
    from[4 * 100] = 1;
    if (!run(cl, program, 1)) return;
    for (int i = 0; i < PIXELS; i++) {
        const double truth = i % WIDTH >= WIDTH / 2 ? 4 : 1;
        before += (from[4 * i] - truth) * (from[4 * i] - truth);
        after += (to[4 * i] - truth) * (to[4 * i] - truth);
    }
    printf("variance %.4g, after a pass %.4g\n", before / PIXELS, after / PIXELS);
    CHECK(after < before / 4);
}

/* A half is filtered only by its own colours and features, since the other half judges it. */
static void check_halves(const ec_cl *cl)
{
    enum { SIDE = 16, COUNT = SIDE * SIDE };
    static float halves[2][2][3 * COUNT], given[4][EC_FILM_FEATURES * COUNT], colours[4][3 * COUNT];
    for (int b = 0; b < 4; b++) {
        for (int i = 0; i < 3 * COUNT; i++) colours[b][i] = (float)test_random();
        for (int i = 0; i < EC_FILM_FEATURES * COUNT; i++) given[b][i] = (float)test_random();
    }
    for (int run = 0; run < 2; run++) {
        ec_film film = {0};
        ec_error err;
        float *const half[2] = {halves[run][0], halves[run][1]};
        CHECK_OK(ec_film_create(&film, SIDE, SIDE, 4, &err), err);
        ec_film_want_features(&film, 2, UINT32_MAX);
        for (uint32_t b = 0; b < 4; b++) {
            for (int i = 0; run && b % 2 && i < EC_FILM_FEATURES * COUNT; i++) given[b][i] += (float)(i % 7);
            CHECK_OK(films_add_with(&film, b, 0, colours[b], given[b], &err), err);
        }
        CHECK_OK(ec_atrous(&cl->info, &film, 1, half, &err), err);
        ec_film_destroy(&film);
    }
    CHECK(!memcmp(halves[0][0], halves[1][0], sizeof halves[0][0]));
    CHECK(memcmp(halves[0][1], halves[1][1], sizeof halves[0][1]));
}

int main(void)
{
    ec_cl cl;
    const int opened = kernel_open(&cl);
    if (opened) return opened;
    cl_program program = kernel_build(&cl, "atrous", 1, NULL);
    for (int apart = 1; program && apart <= 16; apart *= 4) {
        make(0.5);
        if (!run(&cl, program, apart)) break;
        for (int i = 0; i < PIXELS; i++) check_pixel(i % WIDTH, i / WIDTH, apart);
    }
    if (program) check_purpose(&cl, program);
    check_halves(&cl);
    if (program) clReleaseProgram(program);
    ec_cl_close(&cl);
    TEST_END();
}
