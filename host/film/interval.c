/* A pixel's interval: Student's t, corrected for skewness.
 *
 * Noise of light transport is skewed: rare bright paths. The mean of few of them is mostly too low, with a standard error
 * that is too low as well, and the plain t-interval misses the truth above more often than 1 time in 40. Hall (J. R. Statist.
 * Soc. B 54, 1992) transforms T = (mean - truth) / SE, whose skewness comes from that of the mean, gamma, into
 *     g(T) = T + gamma T^2 / 3 + gamma^2 T^3 / 27 + gamma / 6,
 * which has none to this order and is monotone; the interval is where |g(T)| is at most t's quantile. gamma = skewness of a
 * batch / sqrt(B) is far too noisy from one pixel's batches, and worse, small just where the bright paths were missed. So it
 * is pooled over 5 x 5 pixels: mean k3 / mean s^3. R, G and B share the gamma of luminance.
 *
 * A pixel is heavy, its interval not to be trusted, where
 * - |gamma| > 0.4: the expansion ends there (at 0.47 the interval with 16 batches would reach to infinity), or
 * - one batch dominates its sum: it holds a fifth of it more than the fair share 1/B, so that the rule means the same for 2
 *   batches as for 200, or
 * - a bright path met next door would dominate its noise: in 3 x 3 pixels a batch exceeds its own pixel's mean by more than
 *   4 s sqrt(B), four times all of this pixel's scatter.
 * The last is there because a pixel that missed the bright path itself looks blameless: in a caustic, intervals of such
 * pixels hold the truth in half. With two batches there is no skewness: the other rules are left, and the t-interval. */
#include "film/interval.h"

#include <float.h>
#include <math.h>

#include "film/neighbourhood.h"

static const double gamma_most = 0.4, share_most = 0.2, scatter_most = 4;

typedef struct moments {
    double cube, third; /* sums over a neighbourhood of s^3 and of k3, the unbiased third moment */
} moments;

static double skewness_around(const ec_film *film, uint32_t x, uint32_t y)
{
    if (film->batch_count < 3) return 0;
    moments sum = {0};
    ec_neighbourhood around = ec_neighbourhood_of(x, y, EC_INTERVAL_REACH, film->width, film->height);
    for (uint32_t j = around.y0; j < around.y1; j++)
        for (uint32_t i = around.x0; i < around.x1; i++) {
            uint64_t q = (uint64_t)j * film->width + i;
            double n = ec_film_batches(film, q), s2 = film->m2[4 * q + 3] / (n - 1);
            sum.cube += s2 * sqrt(s2);
            sum.third += film->m34[2 * q] * n / ((n - 1) * (n - 2));
        }
    return sum.cube > 0 ? sum.third / (sum.cube * sqrt(ec_film_batches(film, (uint64_t)y * film->width + x))) : 0;
}

/* By how much the pixel's brightest batch exceeds its mean. `largest` is a float: steady pixels have no excess. */
static double excess_of(const ec_film *film, uint64_t p)
{
    return fmax(film->largest[p] - (1 + 1e-6) * ec_luminance(film->mean + 3 * p), 0);
}

static int is_dominated(const ec_film *film, uint32_t x, uint32_t y)
{
    uint64_t p = (uint64_t)y * film->width + x;
    double n = ec_film_batches(film, p), scatter = sqrt(n / (n - 1) * film->m2[4 * p + 3]), excess = 0;
    if (excess_of(film, p) > share_most * n * ec_luminance(film->mean + 3 * p)) return 1;
    ec_neighbourhood around = ec_neighbourhood_of(x, y, 1, film->width, film->height);
    for (uint32_t j = around.y0; j < around.y1; j++)
        for (uint32_t i = around.x0; i < around.x1; i++) excess = fmax(excess, excess_of(film, (uint64_t)j * film->width + i));
    return excess > scatter_most * scatter;
}

/* T with g(T) = y: g is the cubic ((1 + a T)^3 - 1) / (3 a) + gamma / 6 with a = gamma / 3. */
static double inverse_hall(double y, double gamma)
{
    if (fabs(gamma) < 1e-4) return y - gamma * (y * y / 3 + 1.0 / 6);
    return (cbrt(1 + gamma * (y - gamma / 6)) - 1) * 3 / gamma;
}

/* low and high: of the pixel; either may be NULL */
static void write_interval(const ec_film *film, uint64_t p, double most, double least, float *low, float *high)
{
    double n = ec_film_batches(film, p);
    for (int c = 0; c < 3; c++) {
        double mean = film->mean[3 * p + c], se = sqrt(film->m2[4 * p + c] / (n * (n - 1)));
        if (low) low[c] = (float)fmax(mean - most * se, 0); /* radiance is never negative */
        if (high) high[c] = (float)fmin(mean - least * se, FLT_MAX); /* files hold no infinity */
    }
}

static uint64_t know_nothing(uint64_t pixels, float *low, float *high, float *heavy)
{
    for (uint64_t i = 0; i < 3 * pixels; i++) {
        if (low) low[i] = 0;
        if (high) high[i] = INFINITY;
        if (heavy && i < pixels) heavy[i] = 1;
    }
    return pixels;
}

uint64_t ec_film_interval_rows(const ec_film *film, uint32_t first, uint32_t rows, float *low, float *high, float *heavy)
{
    if (film->batch_count < 2) return know_nothing((uint64_t)rows * film->width, low, high, heavy);
    uint32_t n = 0;
    double t = 0;
    uint64_t count = 0, i = 0;
    for (uint32_t y = first; y < first + rows; y++)
        for (uint32_t x = 0; x < film->width; x++, i++) {
            uint64_t p = (uint64_t)y * film->width + x;
            if (n != ec_film_batches(film, p)) t = ec_student_t_quantile(0.975, (n = ec_film_batches(film, p)) - 1.0);
            double gamma = skewness_around(film, x, y);
            int is_heavy = !(fabs(gamma) <= gamma_most) || is_dominated(film, x, y); /* NaN: moments left the range of float */
            gamma = gamma <= gamma_most ? fmax(gamma, -gamma_most) : gamma_most;
            count += (uint64_t)is_heavy;
            if (heavy) heavy[i] = (float)is_heavy;
            if (low || high)
                write_interval(film, p, inverse_hall(t, gamma), inverse_hall(-t, gamma), low ? low + 3 * i : NULL, high ? high + 3 * i : NULL);
        }
    return count;
}
