/* tier: quick */
/* A cube's six faces as an equirectangular map: a smooth function of direction, drawn on the faces by the formulas of OpenGL's table 8.19,
 * must be reproduced everywhere, including edges and corners. */
#include <math.h>

#include "gltf/cube.h"
#include "support/test.h"

static double radiance(const double d[3], int channel)
{
    return channel == 0 ? 1 + 0.5 * d[0] : channel == 1 ? 1 + 0.5 * d[1] * d[2] : 1 + 0.4 * d[2] - 0.3 * d[1];
}

/* The inverse of the table, which gives s and t of a direction; one row a face: s and t run to (sc + 1) / 2, (tc + 1) / 2. */
static void direction(int face, double sc, double tc, double d[3])
{
    double r[6][3] = {{1, -tc, -sc}, {-1, -tc, sc}, {sc, 1, tc}, {sc, -1, -tc}, {sc, -tc, 1}, {-sc, -tc, -1}};
    double length = sqrt(1 + sc * sc + tc * tc);
    for (int k = 0; k < 3; k++) d[k] = r[face][k] / length;
}

static ec_cube draw(uint32_t size)
{
    ec_cube cube = {.size = size};
    for (int f = 0; f < 6; f++) {
        cube.face[f] = malloc(3 * sizeof(float) * size * size);
        for (uint32_t i = 0; i < size * size; i++) {
            double d[3];
            direction(f, 2 * (i % size + 0.5) / size - 1, 2 * (i / size + 0.5) / size - 1, d);
            for (int k = 0; k < 3; k++) cube.face[f][3 * i + (uint32_t)k] = (float)radiance(d, k);
        }
    }
    return cube;
}

/* The largest difference from the function at pixels' centres. */
static double worst(const ec_cube *cube, uint32_t width)
{
    const double pi = 3.14159265358979323846;
    uint32_t height = width / 2;
    float *rgb = malloc(3 * sizeof(float) * width * height);
    double most = 0;
    ec_cube_unroll(cube, width, height, 1, rgb);
    for (uint32_t i = 0; i < width * height; i++) { /* scene.h: u = 0.5 + atan2(z, x) / 2 pi, v = acos(y) / pi */
        double phi = 2 * pi * ((i % width + 0.5) / width - 0.5), theta = pi * (i / width + 0.5) / height;
        double d[3] = {sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi)};
        for (int k = 0; k < 3; k++) most = fmax(most, fabs(rgb[3 * i + (uint32_t)k] - radiance(d, k)));
    }
    free(rgb);
    return most;
}

/* Bilinear interpolation over pixels 2 / size apart errs by their square over 8 times the second derivative, about 1 along a face. Beyond
 * an edge the neighbour's pixels, with weight 1/2 there, are off by up to half a pixel: half of that times the first derivative, 0.5.
 * Pixels of the map are everywhere, within 1 / 300 of edges and corners. */
static void test_smooth(void)
{
    static const uint32_t sizes[] = {1, 2, 8, 64};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        ec_cube cube = draw(sizes[i]);
        double pixel = 2.0 / sizes[i], error = worst(&cube, 1024), most = pixel * pixel / 4 + pixel / 8;
        printf("%u pixels a side: off by %.2g, at most %.2g\n", sizes[i], error, most);
        CHECK_MSG(error < most, "%u pixels a side: off by %g", sizes[i], error);
        ec_cube_free(&cube);
    }
}

/* Neighbouring pixels of a fine map never differ by more than the steepest interpolation allows; at a seam they would. */
static void test_seams(void)
{
    enum { SIZE = 4, WIDTH = 2048, HEIGHT = 1024 };
    ec_cube cube = {.size = SIZE};
    uint32_t state = 5;
    for (int f = 0; f < 6; f++) {
        cube.face[f] = malloc(3 * sizeof(float) * SIZE * SIZE);
        for (int i = 0; i < 3 * SIZE * SIZE; i++) {
            state = state * 1664525u + 1013904223u;
            cube.face[f][i] = (float)(state >> 8) / 16777216.0f;
        }
    }
    float *rgb = malloc(3 * sizeof(float) * WIDTH * HEIGHT);
    ec_cube_unroll(&cube, WIDTH, HEIGHT, 1, rgb);
    /* Values 0 to 1 over pixels 2 / SIZE apart, along both axes; in the corners of a face a step of an angle is up to 3 times that. */
    double step = 2 * 3.14159265 / WIDTH, slope = 2 * 3 * SIZE / 2.0 * step, most = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int k = 0; k < 3; k++) {
                double here = rgb[3 * (y * WIDTH + x) + k], right = rgb[3 * (y * WIDTH + (x + 1) % WIDTH) + k];
                most = fmax(most, fabs(right - here));
                if (y + 1 < HEIGHT) most = fmax(most, fabs(rgb[3 * ((y + 1) * WIDTH + x) + k] - here));
            }
    printf("steps of at most %.3g\n", most);
    CHECK_MSG(most < slope, "a step of %g", most);
    free(rgb);
    ec_cube_free(&cube);
}

/* The mean over all directions is kept: noise of single pixels is not lost between the map's pixels. */
static void test_mean(void)
{
    enum { SIZE = 32, WIDTH = 4 * SIZE, HEIGHT = WIDTH / 2 };
    ec_cube cube = {.size = SIZE};
    const double pi = 3.14159265358979323846;
    double sum = 0, whole = 0, unrolled = 0, area = 0;
    uint32_t state = 5;
    for (int f = 0; f < 6; f++) {
        cube.face[f] = malloc(3 * sizeof(float) * SIZE * SIZE);
        for (uint32_t i = 0; i < SIZE * SIZE; i++) {
            double sc = 2 * (i % SIZE + 0.5) / SIZE - 1, tc = 2 * (i / SIZE + 0.5) / SIZE - 1, solid = pow(1 + sc * sc + tc * tc, -1.5);
            state = state * 1664525u + 1013904223u;
            float value = (state >> 24) < 3 ? 1000.0f : 1.0f;
            for (int k = 0; k < 3; k++) cube.face[f][3 * i + (uint32_t)k] = value;
            sum += solid * value;
            whole += solid;
        }
    }
    float *rgb = malloc(3 * sizeof(float) * WIDTH * HEIGHT);
    ec_cube_unroll(&cube, WIDTH, HEIGHT, 2, rgb);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        double sine = sin(pi * (i / WIDTH + 0.5) / HEIGHT);
        unrolled += sine * rgb[3 * i];
        area += sine;
    }
    double error = unrolled / area / (sum / whole) - 1;
    printf("72 suns of one pixel: the mean is off by %.2g\n", error);
    /* A sun covers about 3 x 3 places of its tent, each off by a tenth of a pixel's width: 2 % each; 70 suns, four standard errors. */
    CHECK_MSG(fabs(error) < 0.01, "the mean is off by %g", error);
    free(rgb);
    ec_cube_free(&cube);
}

int main(void)
{
    test_smooth();
    test_seams();
    test_mean();
    TEST_END();
}
