#include "image/shown.h"

#include "base/luminance.h"

static void show_pixel(const ec_look *look, const double rgb[3], double out[4])
{
    for (int c = 0; c < 3; c++) out[c] = rgb[c];
    ec_tonemap_pixel(out, exp2(look->exposure), look->tonemap);
    out[3] = ec_luminance(out);
}

void ec_show(const ec_look *look, const float *in, uint64_t pixel_count, float *out)
{
#pragma omp parallel for schedule(static)
    for (uint64_t p = 0; p < pixel_count; p++) {
        double shown[4];
        show_pixel(look, (double[3]){in[3 * p], in[3 * p + 1], in[3 * p + 2]}, shown);
        for (uint64_t c = 0; c < 3; c++) out[3 * p + c] = (float)shown[c];
    }
}

/* Returns the correlation between any two channels, from se_y^2 = (1 - r) sum (w se)^2 + r (sum w se)^2, w being the weights of luminance. */
static double correlation(const float se[3], double se_y)
{
    double alone = 0, together = ec_luminance_of_floats(se);
    for (int c = 0; c < 3; c++) {
        float one[3] = {0};
        one[c] = se[c];
        alone += ec_luminance_of_floats(one) * ec_luminance_of_floats(one);
    }
    together *= together;
    return together > alone ? fmin(fmax((se_y * se_y - alone) / (together - alone), 0), 1) : 1;
}

/* Adds what noise along one direction contributes to variance and mean of R, G, B and luminance: a normal variable evaluated at 0 and +-sqrt 3. */
static void add_direction(const ec_look *look, const double rgb[3], const double along[3], double weight, double variance[4], double bend[4])
{
    double middle[4], above[4], below[4], up[3], down[3];
    for (int c = 0; c < 3; c++) up[c] = rgb[c] + sqrt(3) * along[c], down[c] = rgb[c] - sqrt(3) * along[c];
    show_pixel(look, rgb, middle);
    show_pixel(look, up, above);
    show_pixel(look, down, below);
    for (int c = 0; c < 4; c++) {
        double a = above[c] - middle[c], b = below[c] - middle[c], mean = (a + b) / 6;
        variance[c] += weight * ((a * a + b * b) / 6 - mean * mean);
        bend[c] += weight * mean;
    }
}

/* Computes tail_se's reach: where the curve is flat, a bright value does not show how far off it may be. */
static void reach(const ec_look *look, const double rgb[3], const double along[3], double out[3])
{
    double at[3][4];
    for (int k = 0; k < 3; k++) {
        double moved[3];
        for (int c = 0; c < 3; c++) moved[c] = rgb[c] + 4 * (k - 1) * along[c];
        show_pixel(look, moved, at[k]);
    }
    for (int c = 0; c < 3; c++) out[c] = fmax(fabs(at[2][c] - at[1][c]), fabs(at[1][c] - at[0][c])) / 4;
}

void ec_show_noise(const ec_look *look, const ec_measured *linear, float *se, float *se_y, float *slack, float *tail_se)
{
#pragma omp parallel for schedule(static)
    for (uint64_t p = 0; p < (uint64_t)linear->width * linear->height; p++) {
        const float *from = linear->se + 3 * p;
        const double rgb[3] = {linear->rgb[3 * p], linear->rgb[3 * p + 1], linear->rgb[3 * p + 2]}, all[3] = {from[0], from[1], from[2]};
        double variance[4] = {0}, bend[4] = {0}, tail[3], together = linear->se_y ? correlation(from, linear->se_y[p]) : 1;
        reach(look, rgb, all, tail);
        add_direction(look, rgb, all, together, variance, bend);
        for (int c = 0; c < 3 && together < 1; c++) {
            double alone[3] = {0};
            alone[c] = all[c];
            add_direction(look, rgb, alone, 1 - together, variance, bend);
        }
        for (uint64_t c = 0; c < 3; c++) {
            se[3 * p + c] = (float)sqrt(variance[c]);
            slack[3 * p + c] += (float)fabs(bend[c]);
            tail_se[3 * p + c] = (float)fmax(sqrt(variance[c]), tail[c]);
        }
        se_y[p] = (float)sqrt(variance[3]);
    }
}

void ec_show_bend(const ec_look *look, const float *rgb, const float *se, uint64_t pixel_count, float *slack)
{
    const double step = 0.1; /* of brightness; all noise is taken to be along it */
#pragma omp parallel for schedule(static)
    for (uint64_t p = 0; p < pixel_count; p++) {
        double at[3][4];
        for (int k = 0; k < 3; k++) {
            double factor = 1 + step * (k - 1);
            show_pixel(look, (double[3]){rgb[3 * p] * factor, rgb[3 * p + 1] * factor, rgb[3 * p + 2] * factor}, at[k]);
        }
        for (uint64_t c = 0; c < 3; c++) {
            double slope = (at[2][c] - at[0][c]) / (2 * step), curvature = (at[2][c] - 2 * at[1][c] + at[0][c]) / (step * step);
            double spread = slope > 0 ? fmin((double)se[3 * p + c] / slope, 1) : 0;
            slack[3 * p + c] += (float)fabs(curvature * spread * spread / 2);
        }
    }
}
