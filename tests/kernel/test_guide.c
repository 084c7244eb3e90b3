/* tiers: quick, long */
/* The table of path guiding: densities of directions integrate to 1, samples follow them, the host reads the same ones, and they are high
 * where photons came from. In uniform light nothing is guided. */
#include "device/guide.h"
#include "kernel/chi2.h"

#define PHOTONS 40000u
#define N SAMPLES
#define COLUMNS 64u /* of cells of equal area; a multiple of the finest that the table can have here */
#define ROWS 64u

static float points[3 * N], u[2 * N], *const directions = out, *const pdf = out + 3 * N, *const share = out + 4 * N;
static ec_photon photons[PHOTONS];
static double expected[COLUMNS * ROWS];
static uint32_t counts[COLUMNS * ROWS];

static void set_direction(float *d, size_t stride, double x, double y)
{
    const double z = 2 * x - 1, r = sqrt(fmax(1 - z * z, 0));
    d[0] = (float)(r * cos(2 * pi * y));
    d[stride] = (float)(r * sin(2 * pi * y));
    d[2 * stride] = (float)z;
}

/* Half of the light comes straight from above into x < 0, the rest from all directions. */
static void make_photons(void)
{
    for (uint32_t i = 0; i < PHOTONS; i++) {
        const bool from_above = i % 2;
        for (int k = 0; k < 3; k++) photons[i].p[k] = (float)test_random_in(-1, 1);
        if (from_above) photons[i].p[0] = -fabsf(photons[i].p[0]);
        set_direction(photons[i].d, 1, from_above ? 0.5 + 0.5 * cos(0.02 * test_random_in(0, 1)) : test_random_in(0, 1), test_random_in(0, 1));
        photons[i].flux = (float)test_random_in(0.5, 1.5);
    }
}

static uint32_t cell_of(uint32_t i)
{
    const double turn = atan2(directions[N + i], directions[i]) / (2 * pi), x = 0.5 * directions[2 * N + i] + 0.5, y = turn < 0 ? turn + 1 : turn;
    const uint32_t column = (uint32_t)fmin(x * COLUMNS, COLUMNS - 1), row = (uint32_t)fmin(y * ROWS, ROWS - 1);
    return row * COLUMNS + column;
}

/* Host (ec_guide_pdf) and kernel read the same densities, except for directions on the side of a square, where rounding decides. */
static void check_host(const float *table, const float p[3])
{
    uint32_t apart = 0;
    for (uint32_t i = 0; i < N; i += 7) {
        double here;
        const float d[3] = {directions[i], directions[N + i], directions[2 * N + i]};
        const double found = ec_guide_pdf(table, p, d, &here);
        CHECK_MSG(here == (double)share[i], "share %g, of the kernel %g", here, share[i]);
        apart += fabs(found - (double)pdf[i]) > 1e-3 * (double)pdf[i];
    }
    CHECK_MSG(apart < N / 7 / 500, "%u densities differ from the kernel's", apart);
}

/* At one point: N directions, one in each cell of a fine grid, and then N samples. above: share of the light from above; 0: nothing is
 * guided. */
static void check_at(cl_program program, int lanes, const float *table, size_t words, const float p[3], double above)
{
    double sum = 0, narrow = 0;
    memset(expected, 0, sizeof expected);
    memset(counts, 0, sizeof counts);
    for (uint32_t i = 0; i < N; i++)
        for (int k = 0; k < 3; k++) points[(size_t)k * N + i] = p[k];
    for (uint32_t i = 0; i < N; i++) { /* 512 columns, 256 rows: finer in x, since light from above is in the last columns */
        set_direction(directions + i, N, (i % 512 + 0.5) / 512, (i / 512 + 0.5) / 256);
        u[i] = (float)test_random_in(0, 1 - 0x1p-24);
        u[N + i] = (float)test_random_in(0, 1 - 0x1p-24);
    }
    if (!KERNEL_CALL(&cl, program, "guide_density", N / (uint32_t)lanes, SCALAR(samples), IN(table, words), IN(points, 3 * N), IN(directions, 3 * N), OUT(pdf, N), OUT(share, N))) return;
    for (uint32_t i = 0; i < N; i++) {
        const double part = pdf[i] * 4 * pi / N;
        sum += part;
        expected[cell_of(i)] += part * N;
        if (i % 512 >= 504) narrow += part;
    }
    CHECK_MSG(above > 0 || share[0] == 0, "even light guides a share of %g", share[0]);
    if (!(above > 0)) return;
    check_host(table, p);
    CHECK_MSG(share[0] == 0.5f, "directions at x = %g are guided in a share of %g", p[0], share[0]);
    CHECK_MSG(fabs(sum - 1) < 1e-3, "x = %g: densities add up to %.6f", p[0], sum);
    CHECK_MSG(narrow > 0.8 * above && narrow < above + 0.1, "x = %g: %.3f of the light comes from above, not %.3f", p[0], narrow, above);
    if (!KERNEL_CALL(&cl, program, "guide_directions", N / (uint32_t)lanes, SCALAR(samples), IN(table, words), IN(points, 3 * N), IN(u, 2 * N), OUT(directions, 3 * N))) return;
    for (uint32_t i = 0; i < N; i++) counts[cell_of(i)]++;
    check_chi2("guided directions", expected, counts, COLUMNS * ROWS);
}

int main(void)
{
    float *table;
    size_t words;
    ec_error err = {0};
    const float left[3] = {-0.5f, 0.1f, 0.2f}, right[3] = {0.5f, -0.3f, 0.2f};
    const int open = kernel_open(&cl);
    (void)seed; /* tolerance of other tests of densities */
    if (open) return open;
    make_photons();
    CHECK_OK(ec_guide_build(photons, 10, &table, &words, &err), err);
    CHECK_MSG(!table, "ten photons make a table");
    make_photons();
    CHECK_OK(ec_guide_build(photons, PHOTONS, &table, &words, &err), err);
    for (int i = 0; i < kernel_widths(&cl) && !test_failures; i++) {
        const cl_program program = kernel_build(&cl, "guide", lane_widths[i], "");
        if (!program) break;
        check_at(program, lane_widths[i], table, words, left, 2.0 / 3);
        check_at(program, lane_widths[i], table, words, right, 0);
        clReleaseProgram(program);
    }
    free(table);
    ec_cl_close(&cl);
    TEST_END();
}
