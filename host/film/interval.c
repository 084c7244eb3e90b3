/* A pixel's interval: Student's t, corrected for skewness.
 *
 * Noise of light transport is skewed: rare bright paths. The mean of few of them is mostly too low, with a standard error
 * that is too low as well, and the plain t-interval misses the truth above more often than 1 time in 40. Hall (J. R. Statist.
 * Soc. B 54, 1992) transforms T = (mean - truth) / SE, whose skewness comes from that of the mean, gamma, into
 *     g(T) = T + gamma T^2 / 3 + gamma^2 T^3 / 27 + gamma / 6,
 * which has none to this order and is monotone; the interval is where |g(T)| is at most t's quantile. gamma = skewness of a
 * replicate / sqrt(R) is far too noisy from one pixel's replicates, and worse, small just where the bright paths were missed. So it
 * is pooled over 9 x 9 pixels: mean k3 / mean s^3. R, G and B share the gamma of luminance. SE and its degrees of freedom are borrowed
 * from these pixels, too, channel by channel: borrowed.h.
 *
 * A pixel is heavy, its interval not to be trusted, where
 * - |gamma| > 0.45: the expansion ends there (its inverse takes a root of 0 where gamma is 1 / T), or
 * - one sample dominates its light: it holds a fifth of the sum more than the fair share, or
 * - a bright path met next door would dominate its noise: in 3 x 3 pixels a sample exceeds its own pixel's mean by more than
 *   4 standard errors' worth of this pixel, SE times its number of samples.
 * The last is there because a pixel that missed the bright path itself looks blameless: in a caustic, intervals of such
 * pixels hold the truth in half. */
#include "film/interval.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "film/borrowed.h"
#include "film/neighbourhood.h"

static const double gamma_most = 0.45, share_most = 0.2, scatter_most = 4;

/* Pixels side by side that are judged together, and rows and columns that they look at. */
enum { COLUMNS = 64, AROUND = 2 * EC_INTERVAL_REACH + 1, WIDE = COLUMNS + 2 * EC_INTERVAL_REACH };

/* Terms that each pixel adds to the sums of its neighbours: s^3; k3, the unbiased third moment; ln SE^2 of R, G and B; and the squares of these three.
 * The last six are for the ends of intervals alone. */
enum { CUBE, THIRD, NOISE, NOISE2 = NOISE + 3, SUMS = NOISE2 + 3 };

/* A part of a picture: rows of pixels, whose edges are taken for the picture's. */
typedef struct window {
    const ec_pixel *pixels;
    uint32_t width, height;
    uint32_t first, count; /* columns */
    uint32_t sums;         /* terms that are wanted: the first so many */
    double part[SUMS][AROUND][WIDE]; /* the terms of the pixels that the judged row looks at: row y of the picture at y % AROUND, 0 beyond the edges */
    double excess[AROUND][WIDE];     /* by how much the brightest sample of each of these pixels exceeds its mean */
    ec_borrower *borrower;           /* for as many replicates as the pixel judged last has */
} window;

/* Sums for each pixel of the judged row. */
typedef struct around {
    double of[SUMS][COLUMNS]; /* of the terms, over 9 x 9 pixels */
    double excess[COLUMNS];   /* the largest in 3 x 3 pixels */
} around;

static const ec_pixel *at(const window *w, uint32_t x, uint32_t y) { return w->pixels + (uint64_t)y * w->width + x; }

/* Returns where row j - REACH is in `part`; AROUND is added so that it is not negative. */
static uint64_t row_at(uint64_t j) { return (j + AROUND - EC_INTERVAL_REACH) % AROUND; }

/* Returns by how much the pixel's brightest sample exceeds its mean, which is raised by a float's rounding so that steady pixels have no excess. */
static double excess_of(const ec_pixel *p) { return fmax(p->tail[0] - (1 + 1e-6) * ec_luminance(p->mean), 0); }

static double log_noise(const ec_pixel *p, int channel)
{
    const double se2 = ec_pixel_se2(p, channel);
    return se2 > 0 ? log(se2) : NAN;
}

/* Takes row y in place of row y - AROUND. */
static void take_row(window *w, uint64_t y)
{
    const uint64_t row = y % AROUND;
    for (uint32_t i = 0; i < WIDE; i++) {
        const uint64_t x = (uint64_t)w->first + i;
        for (uint32_t k = 0; k < w->sums; k++) w->part[k][row][i] = 0;
        w->excess[row][i] = 0;
        if (y >= w->height || x < EC_INTERVAL_REACH || x >= (uint64_t)w->width + EC_INTERVAL_REACH) continue;
        const ec_pixel *q = at(w, (uint32_t)x - EC_INTERVAL_REACH, (uint32_t)y);
        const double n = q->n, s2 = q->m2[3] / (n - 1);
        w->excess[row][i] = excess_of(q);
        for (int c = 0; w->sums > NOISE && c < 3; c++) {
            const double one = log_noise(q, c);
            w->part[NOISE + c][row][i] = one;
            w->part[NOISE2 + c][row][i] = one * one;
        }
        if (n < 3) continue;
        w->part[CUBE][row][i] = s2 * sqrt(s2);
        w->part[THIRD][row][i] = q->m3 * n / ((n - 1) * (n - 2));
    }
}

/* Sums the terms around each column of row y, rows in order from above. Above the first row there are zeros. */
static void sum_around(const double part[AROUND][WIDE], uint64_t y, double *sums)
{
    double columns[WIDE] = {0};
    for (uint64_t j = y; j < y + AROUND; j++)
        for (uint32_t i = 0; i < WIDE; i++) columns[i] += part[row_at(j)][i];
    for (uint32_t i = 0; i < AROUND; i++)
        for (uint32_t x = 0; x < COLUMNS; x++) sums[x] += columns[x + i];
}

static void look_around(const window *w, uint64_t y, around *sum)
{
    memset(sum, 0, sizeof *sum);
    for (uint32_t k = 0; k < w->sums; k++) sum_around(w->part[k], y, sum->of[k]);
    for (uint64_t j = y + EC_INTERVAL_REACH - 1; j <= y + EC_INTERVAL_REACH + 1; j++)
        for (uint32_t i = EC_INTERVAL_REACH - 1; i <= EC_INTERVAL_REACH + 1; i++)
            for (uint32_t x = 0; x < COLUMNS; x++) {
                const double here = w->excess[row_at(j)][x + i];
                sum->excess[x] = here > sum->excess[x] ? here : sum->excess[x];
            }
}

/* excess: the largest of the pixels around. */
static bool is_dominated(const ec_pixel *p, double excess)
{
    const double scatter = sqrt(ec_pixel_se2(p, 3)) * p->samples;
    return excess_of(p) > share_most * p->samples * ec_luminance(p->mean) || excess > scatter_most * scatter;
}

/* Returns T with g(T) = y: g is the cubic ((1 + a T)^3 - 1) / (3 a) + gamma / 6 with a = gamma / 3. */
static double inverse_hall(double y, double gamma)
{
    if (fabs(gamma) < 1e-4) return y - gamma * (y * y / 3 + 1.0 / 6);
    return (cbrt(1 + gamma * (y - gamma / 6)) - 1) * 3 / gamma;
}

/* Writes the interval of the pixel in column x of the window; low or high may be NULL. */
static void write_interval(const window *w, uint32_t x, uint32_t y, const around *sum, double gamma, float *low, float *high)
{
    const ec_pixel *p = at(w, w->first + x, y);
    const ec_neighbourhood seen = ec_neighbourhood_of(w->first + x, y, EC_INTERVAL_REACH, w->width, w->height);
    const double others = (double)(seen.x1 - seen.x0) * (seen.y1 - seen.y0) - 1;
    for (int c = 0; c < 3; c++) {
        const double se2 = ec_pixel_se2(p, c), own = log_noise(p, c);
        const ec_neighbours around = {others, sum->of[NOISE + c][x] - own, sum->of[NOISE2 + c][x] - own * own};
        const ec_reach reach = ec_borrowed_reach(w->borrower, se2, &around);
        if (low) low[c] = (float)fmax(p->mean[c] - inverse_hall(reach.t, gamma) * reach.se, 0); /* radiance is never negative */
        if (high) high[c] = (float)fmin(p->mean[c] - inverse_hall(-reach.t, gamma) * reach.se, FLT_MAX); /* files hold no infinity */
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

/* Writes the interval of the pixel in column x of the window; returns whether it is heavy. */
static bool judge(const window *w, uint32_t x, uint32_t y, const around *sum, float *low, float *high)
{
    const ec_pixel *p = at(w, w->first + x, y);
    if (p->n < 2) {
        know_nothing(low, high);
        return true;
    }
    double gamma = sum->of[CUBE][x] > 0 ? sum->of[THIRD][x] / (sum->of[CUBE][x] * sqrt(p->n)) : 0;
    const bool is_heavy = !(fabs(gamma) <= gamma_most) || is_dominated(p, sum->excess[x]); /* NaN: moments left the range of double */
    gamma = gamma <= gamma_most ? fmax(gamma, -gamma_most) : gamma_most;
    if (w->sums <= NOISE) return is_heavy;
    if (w->borrower->replicates != p->n) *w->borrower = ec_borrower_of(p->n);
    write_interval(w, x, y, sum, gamma, low, high);
    return is_heavy;
}

/* Judges the window's columns of the row; i: index of the first in what is written. Returns how many are heavy. */
static uint64_t judge_row(const window *w, uint32_t y, uint64_t i, const ec_intervals_of *out)
{
    around sum;
    uint64_t count = 0;
    look_around(w, y, &sum);
    for (uint32_t x = 0; x < w->count; x++, i++) {
        const bool is_heavy = judge(w, x, y, &sum, out->low ? out->low + 3 * i : NULL, out->high ? out->high + 3 * i : NULL);
        if (out->heavy) out->heavy[i] = is_heavy;
        count += is_heavy;
    }
    return count;
}

uint64_t ec_intervals(const ec_pixel *pixels, uint32_t width, uint32_t height, uint32_t first, uint32_t rows,
                      const ec_intervals_of *out)
{
    uint64_t count = 0;
    ec_borrower borrower = {0};
    const uint64_t above = first < EC_INTERVAL_REACH ? 0 : first - EC_INTERVAL_REACH;
    for (uint32_t x = 0; x < width; x += COLUMNS) {
        window w = {.pixels = pixels, .width = width, .height = height, .first = x, .count = width - x < COLUMNS ? width - x : COLUMNS,
                    .sums = out->low || out->high ? SUMS : NOISE, .borrower = &borrower};
        for (uint64_t y = above; y < (uint64_t)first + EC_INTERVAL_REACH; y++) take_row(&w, y);
        for (uint32_t y = first; y < first + rows; y++) {
            take_row(&w, (uint64_t)y + EC_INTERVAL_REACH);
            count += judge_row(&w, y, (uint64_t)(y - first) * width + x, out);
        }
    }
    return count;
}
