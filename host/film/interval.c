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

#include "film/neighbourhood.h"
#include "film/statistics.h"

static const double gamma_most = 0.4, share_most = 0.2, scatter_most = 4;

/* A part of a picture: rows of pixels, whose edges are taken for the picture's. */
typedef struct window {
    const ec_pixel *pixels;
    uint32_t width, height;
    uint32_t n;  /* replicates of the pixel judged last, and … */
    double t;    /* … Student's quantile for that many */
} window;

static const ec_pixel *at(const window *w, uint32_t x, uint32_t y) { return w->pixels + (uint64_t)y * w->width + x; }

static double skewness_around(const window *w, uint32_t x, uint32_t y)
{
    double cubes = 0, thirds = 0; /* sums over a neighbourhood of s^3 and of k3, the unbiased third moment */
    const double n = at(w, x, y)->n;
    if (n < 3) return 0;
    const ec_neighbourhood around = ec_neighbourhood_of(x, y, EC_INTERVAL_REACH, w->width, w->height);
    for (uint32_t j = around.y0; j < around.y1; j++)
        for (uint32_t i = around.x0; i < around.x1; i++) {
            const ec_pixel *q = at(w, i, j);
            const double s2 = q->m2[3] / (n - 1);
            cubes += s2 * sqrt(s2);
            thirds += q->m3 * n / ((n - 1) * (n - 2));
        }
    return cubes > 0 ? thirds / (cubes * sqrt(n)) : 0;
}

/* By how much the pixel's brightest sample exceeds its mean. The largest is a float: steady pixels have no excess. */
static double excess_of(const ec_pixel *p) { return fmax(p->tail[0] - (1 + 1e-6) * ec_luminance(p->mean), 0); }

static bool is_dominated(const window *w, uint32_t x, uint32_t y)
{
    const ec_pixel *p = at(w, x, y);
    const double scatter = sqrt(ec_pixel_se2(p, 3)) * p->samples;
    double excess = 0;
    if (excess_of(p) > share_most * p->samples * ec_luminance(p->mean)) return true;
    const ec_neighbourhood around = ec_neighbourhood_of(x, y, 1, w->width, w->height);
    for (uint32_t j = around.y0; j < around.y1; j++)
        for (uint32_t i = around.x0; i < around.x1; i++) excess = fmax(excess, excess_of(at(w, i, j)));
    return excess > scatter_most * scatter;
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

/* Is the pixel heavy? */
static bool judge(window *w, uint32_t x, uint32_t y, float *low, float *high)
{
    const ec_pixel *p = at(w, x, y);
    if (p->n < 2) {
        know_nothing(low, high);
        return true;
    }
    if (w->n != p->n) w->t = ec_student_t_quantile(0.975, p->n - 1.0), w->n = p->n;
    double gamma = skewness_around(w, x, y);
    const bool is_heavy = !(fabs(gamma) <= gamma_most) || is_dominated(w, x, y); /* NaN: moments left the range of double */
    gamma = gamma <= gamma_most ? fmax(gamma, -gamma_most) : gamma_most;
    if (low || high) write_interval(p, inverse_hall(w->t, gamma), inverse_hall(-w->t, gamma), low, high);
    return is_heavy;
}

uint64_t ec_intervals(const ec_pixel *pixels, uint32_t width, uint32_t height, uint32_t first, uint32_t rows,
                      const ec_intervals_of *out)
{
    window w = {.pixels = pixels, .width = width, .height = height};
    uint64_t count = 0, i = 0;
    for (uint32_t y = first; y < first + rows; y++)
        for (uint32_t x = 0; x < width; x++, i++) {
            const bool is_heavy = judge(&w, x, y, out->low ? out->low + 3 * i : NULL, out->high ? out->high + 3 * i : NULL);
            if (out->heavy) out->heavy[i] = is_heavy;
            count += is_heavy;
        }
    return count;
}
