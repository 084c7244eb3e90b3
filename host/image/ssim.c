#include <math.h>
#include <stdlib.h>

#include "base/luminance.h"
#include "image/flip.h"

enum { RADIUS = 5, SIDE = 2 * RADIUS + 1 };

static void window(double weights[SIDE])
{
    double sum = 0;
    for (int i = 0; i < SIDE; i++) sum += weights[i] = exp(-(i - RADIUS) * (i - RADIUS) / (2 * 1.5 * 1.5));
    for (int i = 0; i < SIDE; i++) weights[i] /= sum;
}

static double at(const float *a, const float *b, uint32_t width, uint32_t x, uint32_t y, const double weights[SIDE]) /* a, b: luma, 1 float per pixel */
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
    for (uint32_t j = 0; j < SIDE; j++)
        for (uint32_t i = 0; i < SIDE; i++) {
            uint64_t p = (uint64_t)(y + j - RADIUS) * width + x + i - RADIUS;
            double w = weights[i] * weights[j], u = a[p], v = b[p];
            ma += w * u, mb += w * v;
            aa += w * u * u, bb += w * v * v, ab += w * u * v;
        }
    return (2 * ma * mb + c1) * (2 * (ab - ma * mb) + c2) / ((ma * ma + mb * mb + c1) * (aa - ma * ma + bb - mb * mb + c2));
}

double ec_ssim(const float *a, const float *b, uint32_t width, uint32_t height, const uint8_t *mask)
{
    const uint64_t pixels = (uint64_t)width * height;
    double weights[SIDE], sum = 0, count = 0, (*rows)[2] = calloc(height, sizeof *rows);
    float *luma = malloc(2 * pixels * sizeof *luma);
    const uint32_t last = rows && luma && width >= SIDE && height >= SIDE ? height - RADIUS : 0;
    for (uint64_t p = 0; luma && p < pixels; p++) {
        luma[p] = (float)ec_luminance_of_floats(a + 3 * p);
        luma[pixels + p] = (float)ec_luminance_of_floats(b + 3 * p);
    }
    window(weights);
#pragma omp parallel for schedule(dynamic, 4)
    for (uint32_t y = RADIUS; y < last; y++)
        for (uint32_t x = RADIUS; x < width - RADIUS; x++) {
            if (mask && !mask[(uint64_t)y * width + x]) continue;
            rows[y][0] += at(luma, luma + pixels, width, x, y, weights);
            rows[y][1]++;
        }
    for (uint32_t y = 0; rows && y < height; y++) sum += rows[y][0], count += rows[y][1]; /* in order: the same bits for any number of threads */
    free(luma);
    free(rows);
    return count > 0 ? sum / count : NAN;
}
