/* tiers: quick, long */
/* Compares samples of light_sample_one, for triangles and environments, with its densities by chi-square; the environment's density must
 * integrate to 1. */
#include "kernel/chi2.h"
#include "pack/distribution.h"
#include "pack/pack.h"
#include "shared/params.h"

static cl_program programs[LANE_WIDTHS];

/* ---- a triangle: cells of equal area, and their parts of its solid angle where it is near ---- */

static double solid_angle_of_cells(const float (*v)[3], const float *p, const double *n, double area, double *cells)
{
    enum { STEPS = 40 };
    double total = 0;
    for (int cell = 0; cell < 100; cell++) {
        cells[cell] = 0;
        for (int step = 0; step < STEPS * STEPS; step++) {
            double root = sqrt((cell / 10 + (step / STEPS + 0.5) / STEPS) / 10), across = (cell % 10 + (step % STEPS + 0.5) / STEPS) / 10;
            double w[3], d2 = 0, projected = 0;
            for (int k = 0; k < 3; k++) {
                w[k] = (1 - root) * (double)v[0][k] + root * (1 - across) * (double)v[1][k] + root * across * (double)v[2][k] - (double)p[k];
                d2 += w[k] * w[k], projected += w[k] * n[k] / (2 * area);
            }
            cells[cell] += area / 100 / STEPS / STEPS * fabs(projected) / (d2 * sqrt(d2));
        }
        total += cells[cell];
    }
    return total;
}

static void check_triangle(int lanes, bool two_sided, bool near, const float *p)
{
    const float v[3][3] = {{-1.0f, 2.0f, 0.5f}, {1.5f, 2.5f, -0.5f}, {0.25f, 3.0f, 2.0f}};
    ec_params params = {.light_choices = 2, .scene_radius = 10};
    ec_light_data table[2] = {{.kind = EC_KIND_TRIANGLE | (two_sided ? EC_LIGHT_TWO_SIDED : 0), .prim = 7},
                              {.kind = EC_KIND_POINT, .prim = EC_NO_ID, .a = {5, 5, 5}, .b = {0, 0, 1}}};
    double e1[3], e2[3], n[3], pmf[2], area = 0;
    for (int k = 0; k < 3; k++) e1[k] = (double)v[1][k] - v[0][k], e2[k] = (double)v[2][k] - v[0][k];
    for (int k = 0; k < 3; k++) n[k] = e1[(k + 1) % 3] * e2[(k + 2) % 3] - e1[(k + 2) % 3] * e2[(k + 1) % 3];
    area = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
    ec_distribution_entry shares[2];
    ec_distribution_build((const double[]){3, 1}, 2, shares, pmf);
    memcpy(table[0].a, v[0], sizeof v[0]);
    memcpy(table[0].b, v[1], sizeof v[1]);
    memcpy(table[0].c, v[2], sizeof v[2]);
    for (int i = 0; i < 2; i++) table[i].pmf = (float)pmf[i];
    table[0].pdf_a = (float)(pmf[0] / area);
    const float nothing[16] = {0};
    lanes %= kernel_widths(&cl);
    if (!KERNEL_CALL(&cl, programs[lanes], "light_samples", samples / (uint32_t)lane_widths[lanes], SCALAR(samples), SCALAR(seed),
                     IN(&params, 1), IN(p, 4), IN(table, 2), IN(shares, 2), IN(nothing, 16), IN(nothing, 16), OUT(out, 4 * SAMPLES)))
        return;
    uint32_t count[101] = {0}, wrong = 0, points = 0, hidden = 0;
    double expected[101], solid_angle = solid_angle_of_cells(v, p, n, area, expected);
    for (int i = 0; i < 100; i++) expected[i] = pmf[0] * SAMPLES * (near ? expected[i] / solid_angle : 0.01);
    expected[100] = pmf[1] * SAMPLES;
    bool seen = two_sided;
    double from_front = 0;
    for (int k = 0; k < 3; k++) from_front += n[k] * ((double)p[k] - v[0][k]);
    seen |= from_front > 0;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double w[3] = {out[i], out[SAMPLES + i], out[2 * SAMPLES + i]}, q[3], s[3], det = 0, b1 = 0, b2 = 0, t = 0, pdf = out[3 * SAMPLES + i];
        if (fabs(w[0] - (5 - p[0]) / sqrt(pow(5 - p[0], 2) + pow(5 - p[1], 2) + pow(5 - p[2], 2))) < 1e-5 && pdf == (double)table[1].pmf) {
            points++;
            count[100]++;
            continue;
        }
        if (pdf == 0) {
            hidden++;
            continue;
        }
        for (int k = 0; k < 3; k++) q[k] = w[(k + 1) % 3] * e2[(k + 2) % 3] - w[(k + 2) % 3] * e2[(k + 1) % 3], s[k] = (double)p[k] - v[0][k];
        for (int k = 0; k < 3; k++) det += e1[k] * q[k], b1 += s[k] * q[k];
        for (int k = 0; k < 3; k++) q[k] = s[(k + 1) % 3] * e1[(k + 2) % 3] - s[(k + 2) % 3] * e1[(k + 1) % 3];
        for (int k = 0; k < 3; k++) b2 += w[k] * q[k], t += e2[k] * q[k];
        b1 /= det, b2 /= det, t /= det;
        double cosine = fabs(n[0] * w[0] + n[1] * w[1] + n[2] * w[2]) / (2 * area);
        double want = near ? pmf[0] / solid_angle : pmf[0] / area * t * t / cosine;
        wrong += fabs(pdf / want - 1) > 1e-4 || fmin(fmin(b1, b2), 1 - b1 - b2) < -1e-5;
        double root = fmin(fmax(b1 + b2, 0), 1), across = fmin(fmax(b2 / fmax(root, 1e-12), 0), 1);
        count[(uint32_t)fmin(root * root * 10, 9) * 10 + (uint32_t)fmin(across * 10, 9)]++;
    }
    CHECK_MSG(wrong == 0, "triangle light: %u samples off the triangle or with another density than theirs", wrong);
    if (seen) check_chi2(near ? "near triangle light" : two_sided ? "triangle light, two-sided" : "triangle light", expected, count, 101);
    else CHECK_MSG(hidden + points == SAMPLES, "a light seen from behind gives %u samples", SAMPLES - hidden - points);
    CHECK(!seen || hidden == 0);
}

/* ---- the environment ---- */

#define WIDTH 24u
#define HEIGHT 12u

enum { CELLS_X = 2 * WIDTH, CELLS_Y = 2 * HEIGHT, CELLS = CELLS_X * CELLS_Y, STEPS = 32 }; /* quarters of patches */

static void directions_of(double u, double v, double *w)
{
    double phi = 2 * pi * (u - 0.5), theta = pi * v;
    w[0] = sin(theta) * cos(phi), w[1] = cos(theta), w[2] = sin(theta) * sin(phi);
}

static double bilinear(const float *rgb, double u, double v)
{
    double x = u * WIDTH - 0.5, y = v * HEIGHT - 0.5, fx = x - floor(x), fy = y - floor(y), sum = 0;
    for (int k = 0; k < 4; k++) {
        int64_t i = ((int64_t)floor(x) + (k & 1) + WIDTH) % WIDTH, j = (int64_t)floor(y) + (k >> 1);
        j = j < 0 ? 0 : (j >= (int64_t)HEIGHT ? HEIGHT - 1 : j);
        sum += (k & 1 ? fx : 1 - fx) * (k & 2 ? fy : 1 - fy) * rgb[3 * (j * WIDTH + i)];
    }
    return sum;
}

/* The sine, interpolated linearly between the poles and the centres of rows. */
static double sine_along_chords(double v)
{
    double y = v * HEIGHT, above = fmax(floor(y - 0.5) + 0.5, 0), below = fmin(floor(y - 0.5) + 1.5, HEIGHT), t = (y - above) / (below - above);
    return (1 - t) * sin(pi * above / HEIGHT) + t * sin(pi * below / HEIGHT);
}

/* Probabilities of the cells, by the midpoint rule; returns the integral over (u, v). */
static double cell_chances(const float *rgb, double *chance)
{
    double total = 0;
    for (int i = 0; i < CELLS; i++) {
        chance[i] = 0;
        for (int k = 0; k < STEPS * STEPS; k++) {
            double u = (i % CELLS_X + (k % STEPS + 0.5) / STEPS) / CELLS_X, v = (i / CELLS_X + (k / STEPS + 0.5) / STEPS) / CELLS_Y;
            chance[i] += bilinear(rgb, u, v) * sine_along_chords(v) / (CELLS * STEPS * STEPS);
        }
        total += chance[i];
    }
    for (int i = 0; i < CELLS; i++) chance[i] /= total;
    return total;
}

/* Sampled directions with their densities, and the density computed again from the direction alone. */
static void check_sampled(const char *name, const float *rgb, const ec_pack *pack, const ec_params *params, int lanes)
{
    static const ec_light_data light = {.kind = EC_KIND_ENVIRONMENT, .prim = EC_NO_ID, .pmf = 1};
    static const ec_distribution_entry only = {0, 0};
    static const float p[4] = {0};
    static float look[2 * SAMPLES];
    static double expected[CELLS];
    const uint32_t texels = 4 * WIDTH * (HEIGHT + 1), table = (WIDTH + 1) * (HEIGHT + 1), groups = samples / (uint32_t)lane_widths[lanes];
    if (!KERNEL_CALL(&cl, programs[lanes], "light_samples", groups, SCALAR(samples), SCALAR(seed), IN(params, 1), IN(p, 4), IN(&light, 1),
                     IN(&only, 1), IN(pack->environment_texels, texels), IN(pack->environment_table, table), OUT(out, 4 * SAMPLES)) ||
        !KERNEL_CALL(&cl, programs[lanes], "environment_densities", groups, SCALAR(samples), IN(params, 1), IN(pack->environment_texels, texels),
                     IN(pack->environment_table, table), IN(out, 3 * SAMPLES), OUT(look, 2 * SAMPLES)))
        return;
    uint32_t count[CELLS] = {0}, wrong = 0, other = 0;
    double total = cell_chances(rgb, expected), most = 0;
    for (int i = 0; i < CELLS; i++) expected[i] *= SAMPLES;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double w[3] = {out[i], out[SAMPLES + i], out[2 * SAMPLES + i]}, sine = sqrt(w[0] * w[0] + w[2] * w[2]), pdf = out[3 * SAMPLES + i];
        double u = atan2(w[2], w[0]) / (2 * pi) + 0.5, v = atan2(sine, w[1]) / pi;
        double want = bilinear(rgb, u, v) * sine_along_chords(v) / total / (2 * pi * pi * sine);
        /* Float directions are off by about 1e-6 of a texel, over which luminance may fall from 200 to 0.01: 1e-4 of the largest value
         * nearby. */
        double around = fmax(fmax(bilinear(rgb, u - 0.5 / WIDTH, v), bilinear(rgb, u + 0.5 / WIDTH, v)), bilinear(rgb, u, v)) / bilinear(rgb, u, v);
        double tolerance = 2e-4 + 2e-5 * around + 1e-6 / sine;
        count[(uint32_t)fmin(v * CELLS_Y, CELLS_Y - 1) * CELLS_X + (uint32_t)fmin(u * CELLS_X, CELLS_X - 1)]++;
        most = fmax(most, fabs(pdf / want - 1));
        wrong += !(fabs(pdf / want - 1) < tolerance);
        other += !(fabs((double)look[i] / pdf - 1) < tolerance);
    }
    printf("environment, %s: densities within %.1e\n", name, most);
    CHECK_MSG(wrong == 0 && other == 0, "environment, %s: %u samples of another density than their light's, %u than is looked up", name, wrong, other);
    check_chi2(name, expected, count, CELLS);
}

/* The density of look-ups integrates to 1, and look-ups give the bilinear map. 288 texels of 21 x 21 points. */
static void check_looked_up(const char *name, const float *rgb, const ec_pack *pack, const ec_params *params)
{
    static float wi[3 * SAMPLES], look[2 * SAMPLES];
    uint32_t n = WIDTH * HEIGHT * 21 * 21 / 16 * 16;
    for (uint32_t i = 0; i < n; i++) {
        double w[3];
        directions_of((i % (WIDTH * 21) + 0.5) / (WIDTH * 21), (i / (WIDTH * 21) + 0.5) / (HEIGHT * 21), w);
        for (uint32_t k = 0; k < 3; k++) wi[k * n + i] = (float)w[k];
    }
    if (!KERNEL_CALL(&cl, programs[EIGHT], "environment_densities", n / 8, SCALAR(n), IN(params, 1), IN(pack->environment_texels, 4 * WIDTH * (HEIGHT + 1)),
                     IN(pack->environment_table, (WIDTH + 1) * (HEIGHT + 1)), IN(wi, 3 * n), OUT(look, 2 * n)))
        return;
    double total = 0, worst = 0, most = 0;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) most = fmax(most, rgb[3 * i]);
    for (uint32_t i = 0; i < n; i++) {
        double u = (i % (WIDTH * 21) + 0.5) / (WIDTH * 21), v = (i / (WIDTH * 21) + 0.5) / (HEIGHT * 21), want = 2 * bilinear(rgb, u, v);
        total += (double)look[i] * sin(pi * v) * 2 * pi / (WIDTH * 21) * pi / (HEIGHT * 21);
        worst = fmax(worst, fabs(look[n + i] - want) / (want + 0.02 * most));
    }
    printf("environment, %s: density integrates to 1 %+.1e, bilinear error %.1e\n", name, total - 1, worst);
    /* 21 points a texel, an odd number: no point is on a corner. */
    CHECK_MSG(fabs(total - 1) < 1e-3, "environment, %s: the density integrates to %.6f", name, total);
    CHECK_MSG(worst < 1e-4, "environment, %s: the look-up is off by %g", name, worst);
}

static void check_environment(const char *name, const float *rgb)
{
    ec_scene scene = {.has_environment = true};
    scene.environment.width = WIDTH;
    scene.environment.height = HEIGHT;
    scene.environment.rgb = (float *)rgb;
    ec_pack pack = {0};
    double mean;
    ec_error err = {0};
    CHECK_OK(ec_pack_environment(&scene, &pack, &mean, &err), err);
    if (!pack.environment_table) return;
    const ec_params params = {.light_choices = 1, .environment = {2, 2, 2, 0}, .environment_width = WIDTH, .environment_height = HEIGHT,
                              .environment_pmf = 1, .scene_radius = 3};
    for (int lanes = 0; lanes <= EIGHT; lanes++) check_sampled(name, rgb, &pack, &params, lanes);
    check_looked_up(name, rgb, &pack, &params);
    free(pack.environment_texels);
    free(pack.environment_table);
}

/* Maps: high contrast with a sun and a black part; a constant one; suns of one texel near either pole and at the seam, in a black sky. */
static void check_environments(void)
{
    static float rgb[3 * WIDTH * HEIGHT];
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        bool black = i % WIDTH > 14 && i / WIDTH > 2 && i / WIDTH < 10;
        float value = black ? 0.0f : i == 5 * WIDTH + 4 ? 200.0f : (float)pow(10, test_random_in(-2, 0.5));
        for (int k = 0; k < 3; k++) rgb[3 * i + (uint32_t)k] = value;
    }
    check_environment("contrasts", rgb);
    for (uint32_t i = 0; i < 3 * WIDTH * HEIGHT; i++) rgb[i] = 0.7f;
    check_environment("constant", rgb);
    static const struct sun {
        const char *name;
        uint32_t x, y;
    } suns[] = {{"sun at the upper pole", 7, 0}, {"sun at the lower pole", 20, HEIGHT - 1}, {"sun at the seam", WIDTH - 1, 8}, {"sun behind the seam", 0, 3}};
    for (int i = 0; i < 4; i++) {
        memset(rgb, 0, sizeof rgb);
        for (uint32_t k = 0; k < 3; k++) rgb[3 * (suns[i].y * WIDTH + suns[i].x) + k] = 1000;
        check_environment(suns[i].name, rgb);
    }
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    chi2_build(programs, "-DFEATURES=(EC_FEATURE_AREA_LIGHTS+EC_FEATURE_PUNCTUAL_LIGHTS+EC_FEATURE_ENVIRONMENT+EC_FEATURE_ENVIRONMENT_MAP)");
    if (!test_failures) {
        check_triangle(0, false, true, (const float[4]){0.1f, -0.3f, 0.2f}); /* in front of the lamp */
        check_triangle(3, false, true, (const float[4]){0.1f, 6.0f, 0.2f}); /* behind it */
        check_triangle(2, true, true, (const float[4]){0.1f, 6.0f, 0.2f});
        check_triangle(1, false, true, (const float[4]){0.2f, 2.45f, 0.6f}); /* 0.04 from its face */
        check_triangle(3, false, true, (const float[4]){1.4f, 2.4f, -0.3f}); /* near a corner */
        check_triangle(0, false, false, (const float[4]){0.1f, -9.0f, 0.2f});
        check_triangle(2, true, false, (const float[4]){-14.0f, 6.0f, 0.2f});
        check_environments();
        printf("%d chi-square tests\n", tests);
        CHECK(tests <= 20);
    }
    chi2_release(programs);
    ec_cl_close(&cl);
    TEST_END();
}
