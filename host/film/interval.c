/* A pixel's interval: Student's t, corrected for skewness.
 *
 * Noise of light transport is skewed: rare bright paths. The mean of few of them is mostly too low, with a standard error
 * that is too low as well, and the plain t-interval misses the truth above more often than 1 time in 40. Hall (J. R. Statist.
 * Soc. B 54, 1992) transforms T = (mean - truth) / SE, whose skewness comes from that of the mean, gamma, into
 *     g(T) = T + gamma T^2 / 3 + gamma^2 T^3 / 27 + gamma / 6,
 * which has none to this order and is monotone; the interval is where |g(T)| is at most t's quantile. gamma = skewness of a
 * replicate / sqrt(R) is far too noisy from one pixel's replicates, and worse, small just where the bright paths were missed. So it
 * is pooled over 5 x 5 pixels: mean k3 / mean s^3. R, G and B share the gamma of luminance.
 *
 * A pixel is heavy, its interval not to be trusted, where
 * - |gamma| > 0.4: the expansion ends there (at 0.47 the interval with 16 replicates would reach to infinity), or
 * - one sample dominates its light: it holds a fifth of the sum more than the fair share, or
 * - a bright path met next door would dominate its noise: in 3 x 3 pixels a sample exceeds its own pixel's mean by more than
 *   4 standard errors' worth of this pixel, SE times its number of samples.
 * The last is there because a pixel that missed the bright path itself looks blameless: in a caustic, intervals of such
 * pixels hold the truth in half. */
#include "film/interval.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "film/statistics.h"

static const double gamma_most = 0.4, share_most = 0.2, scatter_most = 4;

/* Pixels side by side that are judged together, and rows and columns that they look at. */
enum { COLUMNS = 64, AROUND = 2 * EC_INTERVAL_REACH + 1, WIDE = COLUMNS + 2 * EC_INTERVAL_REACH };

/* A part of a picture: rows of pixels, whose edges are taken for the picture's. */
typedef struct window {
    const ec_pixel *pixels;
    uint32_t width, height;
    uint32_t first, count; /* columns */
    /* Of the rows around the one that is judged, row y at y % AROUND, and of the columns around: s^3, k3 (the unbiased third moment), and by how much
     * the brightest sample exceeds the mean. 0 beyond the edges. */
    double cube[AROUND][WIDE], third[AROUND][WIDE], excess[AROUND][WIDE];
    uint32_t n;            /* replicates of the pixel judged last, and … */
    double t;              /* … Student's quantile for that many */
} window;

static const ec_pixel *at(const window *w, uint32_t x, uint32_t y) { return w->pixels + (uint64_t)y * w->width + x; }

/* By how much the pixel's brightest sample exceeds its mean. The largest is a float: steady pixels have no excess. */
static double excess_of(const ec_pixel *p) { return fmax(p->tail[0] - (1 + 1e-6) * ec_luminance(p->mean), 0); }

/* Row y comes in place of row y - AROUND. */
static void take_row(window *w, uint64_t y)
{
    double *cube = w->cube[y % AROUND], *third = w->third[y % AROUND], *excess = w->excess[y % AROUND];
    for (uint32_t i = 0; i < WIDE; i++) {
        const uint64_t x = (uint64_t)w->first + i;
        cube[i] = third[i] = excess[i] = 0;
        if (y >= w->height || x < EC_INTERVAL_REACH || x >= (uint64_t)w->width + EC_INTERVAL_REACH) continue;
        const ec_pixel *q = at(w, (uint32_t)x - EC_INTERVAL_REACH, (uint32_t)y);
        const double n = q->n, s2 = q->m2[3] / (n - 1);
        excess[i] = excess_of(q);
        if (n < 3) continue;
        cube[i] = s2 * sqrt(s2);
        third[i] = q->m3 * n / ((n - 1) * (n - 2));
    }
}

/* Sums over 5 x 5 pixels, and the largest excess in 3 x 3, for all columns of row y at once. Above the first row there are zeros too. */
static void look_around(const window *w, uint64_t y, double *cubes, double *thirds, double *excess)
{
    memset(cubes, 0, COLUMNS * sizeof *cubes);
    memset(thirds, 0, COLUMNS * sizeof *thirds);
    memset(excess, 0, COLUMNS * sizeof *excess);
    for (uint64_t j = y; j < y + AROUND; j++) { /* row j - REACH, AROUND added */
        const uint64_t row = (j + AROUND - EC_INTERVAL_REACH) % AROUND;
        const bool is_near = j + 1 >= y + EC_INTERVAL_REACH && j <= y + EC_INTERVAL_REACH + 1;
        for (uint32_t i = 0; i < AROUND; i++)
            for (uint32_t x = 0; x < COLUMNS; x++) {
                cubes[x] += w->cube[row][x + i];
                thirds[x] += w->third[row][x + i];
            }
        for (uint32_t i = EC_INTERVAL_REACH - 1; is_near && i <= EC_INTERVAL_REACH + 1; i++)
            for (uint32_t x = 0; x < COLUMNS; x++) excess[x] = w->excess[row][x + i] > excess[x] ? w->excess[row][x + i] : excess[x];
    }
}

/* excess: the largest around */
static bool is_dominated(const ec_pixel *p, double excess)
{
    const double scatter = sqrt(ec_pixel_se2(p, 3)) * p->samples;
    return excess_of(p) > share_most * p->samples * ec_luminance(p->mean) || excess > scatter_most * scatter;
}

/* T with g(T) = y: g is the cubic ((1 + a T)^3 - 1) / (3 a) + gamma / 6 with a = gamma / 3. */
static double inverse_hall(double y, double gamma)
{
    if (fabs(gamma) < 1e-4) return y - gamma * (y * y / 3 + 1.0 / 6);
    return (cbrt(1 + gamma * (y - gamma / 6)) - 1) * 3 / gamma;
}

/* low and high: of the pixel; either may be NULL */
static void write_interval(const ec_pixel *p, double most, double least, float *low, float *high)
{
    for (int c = 0; c < 3; c++) {
        const double mean = p->mean[c], se = sqrt(ec_pixel_se2(p, c));
        if (low) low[c] = (float)fmax(mean - most * se, 0); /* radiance is never negative */
        if (high) high[c] = (float)fmin(mean - least * se, FLT_MAX); /* files hold no infinity */
    }
}

/* Nothing is known with fewer than two replicates. */
static void know_nothing(float *low, float *high)
{
    for (int c = 0; c < 3; c++) {
        if (low) low[c] = 0;
        if (high) high[c] = INFINITY;
    }
}

/* Is the pixel heavy? cubes, thirds and excess are those around it. */
static bool judge(window *w, const ec_pixel *p, double cubes, double thirds, double excess, float *low, float *high)
{
    if (p->n < 2) {
        know_nothing(low, high);
        return true;
    }
    if (w->n != p->n) w->t = ec_student_t_quantile(0.975, p->n - 1.0), w->n = p->n;
    double gamma = cubes > 0 ? thirds / (cubes * sqrt(p->n)) : 0;
    const bool is_heavy = !(fabs(gamma) <= gamma_most) || is_dominated(p, excess); /* NaN: moments left the range of double */
    gamma = gamma <= gamma_most ? fmax(gamma, -gamma_most) : gamma_most;
    if (low || high) write_interval(p, inverse_hall(w->t, gamma), inverse_hall(-w->t, gamma), low, high);
    return is_heavy;
}

/* The window's columns of the row; i: the place of the first in what is written. */
static uint64_t judge_row(window *w, uint64_t y, uint64_t i, const ec_intervals_of *out)
{
    double cubes[COLUMNS], thirds[COLUMNS], excess[COLUMNS];
    uint64_t count = 0;
    look_around(w, y, cubes, thirds, excess);
    for (uint32_t x = 0; x < w->count; x++, i++) {
        float *low = out->low ? out->low + 3 * i : NULL, *high = out->high ? out->high + 3 * i : NULL;
        const bool is_heavy = judge(w, at(w, w->first + x, (uint32_t)y), cubes[x], thirds[x], excess[x], low, high);
        if (out->heavy) out->heavy[i] = is_heavy;
        count += is_heavy;
    }
    return count;
}

uint64_t ec_intervals(const ec_pixel *pixels, uint32_t width, uint32_t height, uint32_t first, uint32_t rows,
                      const ec_intervals_of *out)
{
    uint64_t count = 0;
    for (uint32_t x = 0; x < width; x += COLUMNS) {
        window w = {.pixels = pixels, .width = width, .height = height, .first = x, .count = width - x < COLUMNS ? width - x : COLUMNS};
        const uint64_t end = (uint64_t)first + rows;
        for (uint64_t y = first < EC_INTERVAL_REACH ? 0 : first - EC_INTERVAL_REACH; y < first + (uint64_t)EC_INTERVAL_REACH; y++) take_row(&w, y);
        for (uint64_t y = first; y < end; y++) {
            take_row(&w, y + EC_INTERVAL_REACH);
            count += judge_row(&w, y, (y - first) * width + x, out);
        }
    }
    return count;
}
