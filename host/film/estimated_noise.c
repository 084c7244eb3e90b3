#include "film/estimated_noise.h"

#include "film/film.h"
#include "film/neighbourhood.h"

enum { RADIUS = 2 };

/* Channel 3 is luminance. */
static double value_of(const float *rgb, uint64_t pixel, int channel)
{
    return channel < 3 ? (double)rgb[3 * pixel + (uint64_t)channel] : ec_luminance_of_floats(rgb + 3 * pixel);
}

static double variance_of(const ec_measured *image, uint64_t pixel, int channel)
{
    if (!image->se) return 0;
    double se = channel < 3 ? image->se[3 * pixel + (uint64_t)channel] : image->se_y ? image->se_y[pixel] : ec_luminance_of_floats(image->se + 3 * pixel);
    return se * se;
}

/* Estimates a's variance at a pixel: the square of its difference less the mean of its n neighbours' is expected to be (1 + 1 / n) times that, plus
 * what b's variances add. */
static double own_variance(const ec_measured *a, const ec_measured *b, uint32_t x, uint32_t y, int channel)
{
    static const int beside[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    uint64_t p = (uint64_t)y * a->width + x;
    double own = value_of(a->rgb, p, channel) - value_of(b->rgb, p, channel), sum = 0, known = 0, n = 0;
    for (int k = 0; k < 4; k++) {
        uint32_t i = x + (uint32_t)beside[k][0], j = y + (uint32_t)beside[k][1]; /* -1 wraps to the largest number */
        uint64_t q = (uint64_t)j * a->width + i;
        if (i >= a->width || j >= a->height || !ec_counts(a, b, q)) continue;
        sum += value_of(a->rgb, q, channel) - value_of(b->rgb, q, channel);
        known += variance_of(b, q, channel);
        n++;
    }
    if (n == 0) return own * own;
    double apart = own - sum / n;
    return (apart * apart - variance_of(b, p, channel) - known / (n * n)) / (1 + 1 / n);
}

static float smoothed(const ec_measured *a, const ec_measured *b, uint32_t x, uint32_t y, int channel)
{
    ec_neighbourhood around = ec_neighbourhood_of(x, y, RADIUS, a->width, a->height);
    double sum = 0, count = 0;
    for (uint32_t j = around.y0; j < around.y1; j++)
        for (uint32_t i = around.x0; i < around.x1; i++) {
            if (!ec_counts(a, b, (uint64_t)j * a->width + i)) continue;
            sum += own_variance(a, b, i, j, channel);
            count++;
        }
    return count > 0 && sum > 0 ? (float)sqrt(sum / count) : 0;
}

void ec_estimate_noise(const ec_measured *a, const ec_measured *b, float *se, float *se_y)
{
#pragma omp parallel for schedule(static)
    for (uint32_t y = 0; y < a->height; y++)
        for (uint32_t x = 0; x < a->width; x++) {
            uint64_t p = (uint64_t)y * a->width + x;
            for (int c = 0; c < 3; c++) se[3 * p + (uint64_t)c] = smoothed(a, b, x, y, c);
            se_y[p] = smoothed(a, b, x, y, 3);
        }
}
