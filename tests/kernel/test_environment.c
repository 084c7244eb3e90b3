/* tier: quick */
/* A map of 4096 x 2048 whose sun is one texel of 1e6 in a sky of 1, with a hundred black rows: the density is that of the samples. With 32
 * bits, a patch near the pole would have less than one random number; a row of patches has several, which its patches share. */
#include "kernel/kernel_run.h"
#include "pack/pack.h"
#include "shared/params.h"

#define WIDTH 4096u
#define HEIGHT 2048u
#define TEXELS (WIDTH * HEIGHT)
#define PATCHES (WIDTH * (HEIGHT + 1))
#define TABLE (PATCHES + HEIGHT + 1)
#define SAMPLES (1u << 21)
#define SUN_X 1234u
#define SUN_Y 600u
#define BLACK_FIRST 1500u
#define BLACK_END 1600u

static const double pi = 3.14159265358979323846;
static ec_cl cl;
static cl_program program;
static ec_pack pack;
static float wi[3 * TEXELS], look[2 * TEXELS], out[4 * SAMPLES];
static const ec_params params = {
    .light_choices = 1, .environment = {1, 1, 1, 1}, .environment_width = WIDTH, .environment_height = HEIGHT, .environment_pmf = 1, .scene_radius = 3};

static void make_map(void)
{
    float *rgb = malloc(3 * TEXELS * sizeof *rgb);
    if (!rgb) exit(1);
    for (uint32_t i = 0; i < 3 * TEXELS; i++) {
        uint32_t y = i / 3 / WIDTH;
        rgb[i] = y >= BLACK_FIRST && y < BLACK_END ? 0.0f : i / 3 == SUN_Y * WIDTH + SUN_X ? 1e6f : 1.0f;
    }
    ec_scene scene = {.has_environment = true};
    scene.environment.width = WIDTH;
    scene.environment.height = HEIGHT;
    scene.environment.rgb = rgb;
    double mean;
    ec_error err = {0};
    CHECK_OK(ec_pack_environment(&scene, &pack, &mean, &err), err);
    free(rgb);
}

/* Luminance at a corner of row y of patches, which is between rows y - 1 and y of texels. */
static double corner(uint32_t x, int64_t y)
{
    y = y < 0 ? 0 : y < (int64_t)HEIGHT ? y : (int64_t)HEIGHT - 1;
    return y >= (int64_t)BLACK_FIRST && y < (int64_t)BLACK_END ? 0 : y == (int64_t)SUN_Y && x % WIDTH == SUN_X ? 1e6 : 1;
}

static double sine_of_edge(double y) { return y <= 0 || y >= HEIGHT ? 0 : sin(pi * y / HEIGHT); }

/* Luminance times the sine, over a patch. */
static double integral(uint32_t x, uint32_t y)
{
    double upper = corner(x, (int64_t)y - 1) + corner(x + 1, (int64_t)y - 1), lower = corner(x, y) + corner(x + 1, y);
    double above = sine_of_edge(y - 0.5), below = sine_of_edge(y + 0.5), part = y == 0 || y == HEIGHT ? 0.25 : 0.5;
    return part * (upper * (above / 3 + below / 6) + lower * (above / 6 + below / 3));
}

/* Share of n numbers for each entry: from its first number to the next entry's. */
static uint64_t share(const ec_distribution_entry *table, uint32_t n, uint32_t i)
{
    return (uint32_t)((i + 1 < n ? table[i + 1].first : 0) - table[i].first);
}

/* The tables pick each patch as often as its scale says, and never a black one. */
static void check_table(void)
{
    uint64_t wrong = 0, dark = 0, empty = 0;
    for (uint32_t y = 0; y <= HEIGHT; y++) {
        const ec_distribution_entry *row = pack.environment_table + HEIGHT + 1 + (size_t)y * WIDTH;
        double of_row = (double)share(pack.environment_table, HEIGHT + 1, y) * 0x1p-32;
        for (uint32_t x = 0; x < WIDTH; x++) {
            double pmf = of_row > 0 ? of_row * (double)share(row, WIDTH, x) * 0x1p-32 : 0, light = integral(x, y);
            double said = (double)pack.environment_texels[4 * (y * WIDTH + x) + 3] * light * 2 * pi * pi / TEXELS;
            wrong += !(fabs(said - pmf) <= 1e-6 * pmf);
            dark += !(light > 0) && pmf > 0;
            empty += light > 0 && !(pmf > 0);
        }
    }
    CHECK_MSG(wrong == 0 && dark == 0 && empty == 0, "%llu patches of another probability, %llu black ones sampled, %llu never",
              (unsigned long long)wrong, (unsigned long long)dark, (unsigned long long)empty);
}

/* The density that a path finds at the centre of every texel. Centres are patches' corners, where the density is extreme, and their mean is
 * that of the patches. Only the sun differs: the mean of its pyramid is a quarter of its peak, and counts for as many texels. */
static void check_integral(void)
{
    for (uint32_t i = 0; i < TEXELS; i++) {
        double phi = 2 * pi * ((i % WIDTH + 0.5) / WIDTH - 0.5), theta = pi * (i / WIDTH + 0.5) / HEIGHT;
        wi[i] = (float)(sin(theta) * cos(phi));
        wi[TEXELS + i] = (float)cos(theta);
        wi[2 * TEXELS + i] = (float)(sin(theta) * sin(phi));
    }
    uint32_t n = TEXELS;
    if (!KERNEL_CALL(&cl, program, "environment_densities", n / 8, SCALAR(n), IN(&params, 1), IN(pack.environment_texels, 4 * PATCHES),
                     IN(pack.environment_table, TABLE), IN(wi, 3 * TEXELS), OUT(look, 2 * TEXELS)))
        return;
    double total = 0;
    uint32_t dark = 0;
    for (uint32_t i = 0; i < TEXELS; i++) {
        bool black = i / WIDTH >= BLACK_FIRST && i / WIDTH < BLACK_END;
        total += (double)look[i] * sin(pi * (i / WIDTH + 0.5) / HEIGHT) * 2 * pi / WIDTH * pi / HEIGHT;
        dark += black && look[i] > 1e-3f * look[0]; /* a float direction lies beside the row */
    }
    printf("density integrates to 1 %+.1e\n", total - 1);
    CHECK_MSG(fabs(total - 1) < 1e-3 && dark == 0, "the density integrates to %.8f; %u black directions have one", total, dark);
}

/* Irradiance of a plane that faces up: pi, and the sun's pyramid over 2 x 2 texels. */
static double irradiance(void)
{
    enum { STEPS = 100 };
    double sum = pi;
    for (int j = 0; j < STEPS; j++)
        for (int i = 0; i < STEPS; i++) {
            double x = 2 * (i + 0.5) / STEPS - 1, y = 2 * (j + 0.5) / STEPS - 1, theta = pi * (SUN_Y + 0.5 + y) / HEIGHT;
            double area = pow(2.0 / STEPS, 2) * 2 * pi / WIDTH * pi / HEIGHT;
            sum += cos(theta) * sin(theta) * area * (1 - fabs(x)) * (1 - fabs(y)) * (1e6 - 1);
        }
    return sum;
}

static void check_samples(void)
{
    const ec_light_data light = {.kind = EC_KIND_ENVIRONMENT, .prim = EC_NO_ID, .pmf = 1};
    const ec_distribution_entry only = {0, 0};
    const float p[4] = {0};
    uint32_t n = SAMPLES, seed = 1, dark = 0, other = 0;
    if (!KERNEL_CALL(&cl, program, "light_samples", n / 8, SCALAR(n), SCALAR(seed), IN(&params, 1), IN(p, 4), IN(&light, 1), IN(&only, 1),
                     IN(pack.environment_texels, 4 * PATCHES), IN(pack.environment_table, TABLE), OUT(out, 4 * SAMPLES)) ||
        !KERNEL_CALL(&cl, program, "environment_densities", n / 8, SCALAR(n), IN(&params, 1), IN(pack.environment_texels, 4 * PATCHES),
                     IN(pack.environment_table, TABLE), IN(out, 3 * SAMPLES), OUT(look, 2 * SAMPLES)))
        return;
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double up = out[SAMPLES + i], pdf = out[3 * SAMPLES + i], x = look[SAMPLES + i] * fmax(up, 0) / pdf;
        double row = acos(fmin(fmax(up, -1), 1)) / pi * HEIGHT;
        dark += row > BLACK_FIRST + 0.51 && row < BLACK_END - 0.51;
        other += fabs(look[i] / pdf - 1) > 1e-2;
        sum += x / SAMPLES;
        squares += x * x / SAMPLES;
    }
    double se = sqrt((squares - sum * sum) / SAMPLES), want = irradiance();
    printf("irradiance %.5f +- %.5f, expected %.5f; %u samples of other densities than looked up\n", sum, se, want, other);
    CHECK_MSG(dark == 0, "%u samples in black rows", dark);
    CHECK_MSG(fabs(sum - want) < 4 * se && se < 2e-3 * want, "irradiance %.6f +- %.6f, expected %.6f", sum, se, want);
    /* Angles of float directions are off by 6e-4 of such a texel. Where light falls to that fraction of the sun's, or to black, its density
     * loses digits. */
    CHECK_MSG(other < SAMPLES / 2000, "%u samples are found again with another density", other);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    program = kernel_build(&cl, "chi2", 8, "-DFEATURES=(EC_FEATURE_ENVIRONMENT+EC_FEATURE_ENVIRONMENT_MAP)");
    if (!test_failures) make_map();
    if (!test_failures) {
        check_table();
        check_integral();
        check_samples();
    }
    free(pack.environment_texels);
    free(pack.environment_table);
    if (program) clReleaseProgram(program);
    ec_cl_close(&cl);
    TEST_END();
}
