/* Blurs an environment by a von Mises-Fisher distribution over directions, the analogue of the normal distribution on the sphere (Fisher 1953,
 * "Dispersion on a sphere"). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/blur.h"

#define PI 3.14159265358979323846
enum { LEAST = 16, MOST = 1024 }; /* texels around the horizon */
static const double reach = 4;    /* standard deviations: 0.03 % of the weight lies beyond */

/* Shrinks the map: averages samples of `from` within each texel of `to`, enough of them that every texel counts. */
static void shrink(const ec_environment *from, const ec_made_map *to)
{
    const uint32_t looks = (from->width + to->width - 1) / to->width;
#pragma omp parallel for schedule(static)
    for (uint32_t y = 0; y < to->height; y++)
        for (uint32_t x = 0; x < to->width; x++) {
            double sum[3] = {0};
            for (uint32_t k = 0; k < looks * looks; k++) {
                const double u = (x + (k % looks + 0.5) / looks) / to->width, v = (y + (k / looks + 0.5) / looks) / to->height;
                const float *texel = from->rgb + 3 * ((uint64_t)(v * from->height) * from->width + (uint64_t)(u * from->width));
                for (int c = 0; c < 3; c++) sum[c] += texel[c];
            }
            for (uint64_t c = 0; c < 3; c++) to->rgb[3 * ((uint64_t)y * to->width + x) + c] = (float)(sum[c] / (looks * looks));
        }
}

/* Blurs one texel, over the rows and columns within reach. All texels of a row have the weight of their solid angle. */
static void blur_texel(const ec_made_map *from, uint32_t x, uint32_t y, double sigma, float *to)
{
    const double theta = PI * (y + 0.5) / from->height, kappa = 1 / (sigma * sigma), most = fmin(reach * sigma, PI);
    const int32_t first = (int32_t)floor((theta - most) / PI * from->height), last = (int32_t)ceil((theta + most) / PI * from->height);
    double sum[4] = {0};
    for (int32_t v = first < 0 ? 0 : first; v <= last && v < (int32_t)from->height; v++) {
        const double t = PI * (v + 0.5) / from->height, omega = ec_made_map_solid_angle(from, (uint32_t)v);
        const double limit = (cos(most) - cos(theta) * cos(t)) / (sin(theta) * sin(t)); /* least cosine of the difference in longitude */
        const double side = limit >= 1 ? 0 : limit <= -1 ? PI : acos(limit);
        const int32_t half = (int32_t)fmin(ceil(side / (2 * PI) * from->width), from->width / 2);
        for (int32_t k = -half; k < (half < (int32_t)from->width / 2 ? half + 1 : half); k++) {
            const double cosine = cos(theta) * cos(t) + sin(theta) * sin(t) * cos(2 * PI * k / from->width), weight = omega * exp(kappa * (cosine - 1));
            const float *texel = from->rgb + 3 * ((uint64_t)v * from->width + (uint64_t)(((int32_t)x + k + (int32_t)from->width) % (int32_t)from->width));
            for (int c = 0; c < 3; c++) sum[c] += weight * texel[c];
            sum[3] += weight;
        }
    }
    for (int c = 0; c < 3; c++) to[c] = (float)(sum[c] / sum[3]);
}

/* Chooses texels at most half a standard deviation wide. */
static uint32_t choose_width(double sigma)
{
    uint32_t width = LEAST;
    while (width < MOST && 2 * PI / width > 0.5 * sigma) width *= 2;
    return width;
}

ec_result ec_environment_blur(const ec_environment *e, double degrees, ec_made_map *blurred, ec_error *err)
{
    const double sigma = degrees * PI / 180;
    const uint32_t width = choose_width(sigma), height = width / 2;
    const size_t size = 3 * sizeof(float) * width * height;
    *blurred = (ec_made_map){width, height, malloc(size)};
    const ec_made_map small = {width, height, malloc(size)};
    if (!blurred->rgb || !small.rgb) {
        free(blurred->rgb);
        free(small.rgb);
        return ec_fail(err, "out of memory for a blurred environment");
    }
    for (size_t i = 0; i < 3 * (size_t)width * height; i++) blurred->rgb[i] = e->constant[i % 3];
    if (e->rgb) {
        shrink(e, &small);
#pragma omp parallel for schedule(dynamic, 1)
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++) blur_texel(&small, x, y, sigma, blurred->rgb + 3 * ((uint64_t)y * width + x));
    }
    free(small.rgb);
    return EC_OK;
}
