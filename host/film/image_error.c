/* The image's error and its 95 % upper bound.
 *
 * Setting. Pixel p has n = R means of replicates' luminance, independent of each other and of other pixels' (true of this renderer:
 * each pixel and replicate has its own random numbers and no filter shares samples), with true mean mu_p and variance v_p.
 *   E^2    = mean_p e_p^2,       e_p the pixel's real error        -- unknown
 *   est^2  = mean_p s_p^2 / n,   s_p^2 the sample variance         -- the stated error, unbiased for E^2
 * and both are divided by the image's mean luminance. A given render may well err by more than est.
 *
 * How much more? With y_i the deviations of a pixel's replicates from mu_p,
 *   n e_p^2 - s_p^2 = sum_{i!=j} y_i y_j / (n-1),
 * so whatever the distribution, skewed or not (no third or fourth moment enters),
 *   Var(E^2 - est^2) = 2 G / (P n)^2 * n / (n-1),   G = sum_p v_p^2.
 * That is the variance of the ratio of two independent chi-squares with nu = (sum_p v_p)^2 / G and nu (n-1) degrees of
 * freedom (Satterthwaite, Biometrics 2, 1946): exact for normal pixels of equal variance, right in mean and variance for
 * all. Hence E^2 <= est^2 F with F a quantile of Fisher's F(nu, nu (n-1)), near 1 for nu in the thousands.
 *
 * The divisor M, the image's mean, is an estimate too, with relative variance r = est^2 / (P M^2). Its error is
 * uncorrelated with E^2 - est^2 (each term keeps a factor y of mean 0), so the two half-widths of ln E^2, ln F and 2 z sqrt(r),
 * add in squares. In logarithms, since a mean that a few bright samples make is known by a factor: through a keyhole, where it came out
 * up to 4 times too high, bounds held in 90 of 100 renders otherwise.
 *
 * Where a few bright samples make the noise, as those of a highlight within a pixel do, they come or they do not: their number is Poisson's.
 * K equal ones would make as much of it (bright_samples), and their mean number stays under Poisson's upper limit for K: a third width of
 * ln E^2. On a golden knot under a map with small lamps, bounds held in 17 of 20 renders otherwise.
 *
 * nu is too large where one pixel holds much of the noise and its replicates happen to agree: then est comes out low too. How many pixels
 * hold the noise is also told by the spread of their single samples, which are many more than replicates: (sum u)^2 / sum u^2. u is the
 * variance that the mean would have of samples without order, over m^(1/4), m the number of bright samples. Stratification leaves sqrt(m) of
 * those to chance that meet what has an edge within the pixel (Mitchell, SIGGRAPH 1996), and by u / sqrt(m) this comes to 0.6 to 1.1 times the
 * nu of many renders, on seven scenes; half of that is granted, since a few large terms of chi-square have a longer tail than F of the same
 * nu. The less of the two is taken. Where a chrome ball shows a lamp within one pixel, bounds held in 37 of 40 renders otherwise.
 *
 * Samples brighter than any yet may come (larger_samples). Places in the picture that send a sample of size x or more, x how far one moves
 * its pixel's mean, are taken to be as many as x^(-1/xi) says (Pareto), xi by the largest few (Hill, Ann. Statist. 3, 1975), at most 1, as
 * light has a mean. These few are of pixels that met one such sample each (what was met once tells of what was not: Good, Biometrika 40,
 * 1953). A place that expects one sample has none in 1 / e of renders: beyond what size is such a place to be expected in one render of 20?
 * Its light is missing, and E^2 the larger by the square of that. On a plastic knot whose rim glints within one pixel, bounds held in 35 of
 * 40 renders otherwise.
 *
 * Where it holds: tests/host/test_film_coverage.c prints the table. With n = 2 or 3 the spread of a sample variance cannot
 * be told from the pixel's own kurtosis; normal pixels are assumed, which is too wide for skewed ones and too narrow if
 * one or a few pixels hold nearly all the noise. Of light that no sample has met no estimate can know. */
#include <math.h>
#include <string.h>

#include "film/pixel.h"
#include "film/statistics.h"
#include "film/threads.h"

#define MANY 1e6   /* bright samples: with more, their number is as good as known */
#define TWO 2.0    /* bright samples of a pixel, by their fourth powers: fewer count as one */
#define FEWEST 3   /* places that it takes to tell of others */
#define MISSED 0.05 /* expected number of places whose samples are larger than any yet, and did not come */

/* Returns an estimate of v^2 that is unbiased for any distribution, by k-statistics (Fisher 1930; Kendall & Stuart ch. 12) E[k2^2] = v^2
 * (n+1)/(n-1) + kappa4/n and E[k4] = kappa4. */
static double squared_variance(double n, double m2, double m4)
{
    double k2 = m2 / (n - 1);
    double k4 = n * ((n + 1) * m4 - 3 * (n - 1) / n * m2 * m2) / ((n - 1) * (n - 2) * (n - 3));
    double value = (k2 * k2 - k4 / n) * (n - 1) / (n + 1);
    return isfinite(value) ? value : k2 * k2; /* m4 left the range of double (deviations beyond 1e77): the wider choice */
}

static double not_below(double least, double x) { return x > least ? x : least; } /* fmax is a call, for the sake of NaN */

static void add_pixel(const ec_pixel *p, ec_error_sums *sums)
{
    const double n = p->n, s2 = ec_pixel_se2(p, 3), s4 = s2 * s2;
    const double v2 = n >= 4 ? squared_variance(n, p->m2[3], p->m4) / (n * n) : s4;
    const double y = ec_luminance(p->mean), excess = not_below(0, p->tail[0] - (1 + 1e-6) * y); /* the largest is a float: steady pixels have none */
    const double squares = (double)p->tail[0] * p->tail[0] * p->tail[1];
    const double bright = p->tail[2] > 0 ? not_below(1, (double)p->tail[1] * p->tail[1] / p->tail[2]) : 1;
    const double u2 = p->samples > 1 ? not_below(0, squares / p->samples - y * y) / (p->samples - 1) / sqrt(sqrt(bright)) : 0;
    sums->luminance += y;
    sums->samples += p->samples;
    ec_tail_add(&sums->tail, excess / not_below(1, p->samples));
    if (p->tail[2] < TWO) ec_tail_add(&sums->single, excess / not_below(1, p->samples));
    sums->s2 += s2;
    sums->s4 += s4;
    sums->v4 += v2;
    sums->v8 += v2 * v2;
    sums->u2 += u2;
    sums->u4 += u2 * u2 * (1 - 1 / bright); /* without what a sample has with itself: as if u's square had no error of its own */
    for (int c = 0; c < 3; c++) {
        double x = fabs(p->mean[c]) + EC_RELMSE_FLOOR;
        sums->relative += ec_pixel_se2(p, c) / (x * x);
        sums->largest = fmax(sums->largest, ec_pixel_se2(p, c));
    }
}

/* A film of one replicate has no spread, so that its luminance is all there is to sum. */
static void sum_luminance(const ec_film *film, uint32_t row, ec_error_sums *sums)
{
    double mean[3 * EC_PIXELS];
    uint32_t replicate = 0;
    while (!(film->samples[replicate] > 0)) replicate++;
    for (uint64_t x = 0; x < film->width; x += EC_PIXELS) {
        const uint64_t count = film->width - x < EC_PIXELS ? film->width - x : EC_PIXELS;
        ec_film_replicate(film, (uint64_t)row * film->width + x, count, replicate, mean);
        for (uint64_t i = 0; i < count; i++) sums->luminance += ec_luminance(&mean[3 * i]);
    }
}

static void sum_row(const ec_film *film, uint32_t row, ec_error_sums *sums)
{
    ec_pixel piece[EC_PIXELS];
    if (film->unsampled && !memchr(film->unsampled + (uint64_t)row * film->width, 0, film->width)) return; /* black, in a film of one replicate */
    if (ec_film_replicates(film) == 1) {
        sum_luminance(film, row, sums);
        return;
    }
    for (uint64_t x = 0; x < film->width; x += EC_PIXELS) {
        const uint64_t count = film->width - x < EC_PIXELS ? film->width - x : EC_PIXELS;
        ec_film_look(film, (uint64_t)row * film->width + x, count, piece);
        for (uint64_t i = 0; i < count; i++) add_pixel(&piece[i], sums);
    }
}

static void add_row(const ec_error_sums *row, ec_error_sums *sums)
{
    sums->luminance += row->luminance;
    sums->s2 += row->s2;
    sums->s4 += row->s4;
    sums->relative += row->relative;
    sums->v4 += row->v4;
    sums->v8 += row->v8;
    sums->u2 += row->u2;
    sums->u4 += row->u4;
    sums->samples += row->samples;
    sums->largest = fmax(sums->largest, row->largest);
    ec_tail_join(&sums->tail, &row->tail);
    ec_tail_join(&sums->single, &row->single);
}

/* Sums rows by all threads, and the rows' sums in order: the same bits for any number of threads, and of strips. */
void ec_film_sum_errors(const ec_film *film, ec_error_sums *sums)
{
    enum { ROWS = 64 };
    ec_error_sums rows[ROWS];
    for (uint32_t first = 0; first < film->height; first += ROWS) {
        const uint32_t count = film->height - first < ROWS ? film->height - first : ROWS;
        memset(rows, 0, sizeof rows);
#pragma omp parallel for if (ec_film_is_many((uint64_t)film->width * film->height))
        for (uint32_t k = 0; k < count; k++) sum_row(film, first + k, &rows[k]);
        for (uint32_t k = 0; k < count; k++) add_row(&rows[k], sums);
    }
}

/* Returns how many equal samples would make the noise as the few largest do: (sum v)^2 / sum x^4, x how far one moved its pixel's mean. */
static double bright_samples(const ec_error_sums *sums)
{
    double fourth = 0;
    for (uint32_t i = 0; i < sums->tail.count; i++) fourth += pow(sums->tail.largest[i], 4);
    return fmax(sums->s2 * sums->s2 / fourth, 1); /* infinite where none stands out */
}

/* Returns the square root of how much larger a picture's E^2 is, over its noise, if a place has samples larger than the largest few; *falls: it goes
 * as the number of samples to the power of minus that, as samples of expected number 1 are of size n^xi, over n, and noise goes as 1 / n. */
static double larger_samples(const ec_error_sums *sums, double *falls)
{
    const ec_tail *t = &sums->single;
    double logs = 0;
    *falls = 0;
    if (t->count < FEWEST) return 0;
    const double count = t->count, least = t->largest[t->count - 1];
    for (uint32_t i = 0; i + 1 < t->count; i++) logs += log(t->largest[i] / least);
    const double xi = fmin(logs / (count - 1), 1);
    *falls = fmax(0.5 - xi, 0);
    return least * pow(fmax(count * exp(-1) / MISSED, 1), xi) / sqrt(sums->s2);
}

/* Returns nu. G is taken one standard error high, since it comes out low just when a noisy pixel's variance does, and then both would make the
 * bound too small; with many pixels that margin vanishes. */
static double effective_pixels(const ec_error_sums *sums, double n, double pixels)
{
    double v4 = sums->v4, v8 = sums->v8;
    if (n < 4) { /* normal pixels: moments of chi-square with n-1 degrees of freedom */
        double f = n - 1, fourth = 1 + 2 / f, eighth = fourth * (1 + 4 / f) * (1 + 6 / f);
        v4 /= fourth;
        v8 /= eighth;
    }
    double s2_squared = sums->s2 * sums->s2;
    double G = v4 + sqrt(v8);
    G = fmin(fmax(G, s2_squared / pixels), sums->s4); /* sum v^2 >= (sum v)^2 / P; and E[s^4] >= v^2 */
    const double nu = 1 + (s2_squared - sums->s4) / G; /* for one noisy pixel exactly 1 */
    return sums->u4 > 0 ? fmin(nu, sums->u2 * sums->u2 / sums->u4) : nu;
}

double ec_film_error_bound(double square, double noisy_pixels, double bright_samples, double larger, double pixels, double replicates)
{
    double from_pixels = log(ec_f_quantile(EC_BOUND_CONFIDENCE, noisy_pixels, noisy_pixels * fmax(replicates - 1, 1)));
    double from_mean = 2 * ec_normal_upper_quantile(1 - EC_BOUND_CONFIDENCE) * sqrt(square / pixels);
    double from_samples = bright_samples < MANY ? log(ec_poisson_upper_mean(EC_BOUND_CONFIDENCE, bright_samples) / bright_samples) : 0;
    return sqrt(square) * hypot(exp(0.5 * hypot(hypot(from_pixels, from_mean), from_samples)), larger);
}

/* Widens the bound by light that may be missing; there is no bound where that light may be more than the noise. Where some of it was met by chance,
 * the picture is brighter and its error larger for it; then a few samples hold most of the noise, and what is missing is compared with the picture
 * without them. */
static void judge(const ec_error_sums *sums, double pixels, const ec_rare *rare, double limit, ec_film_error *e)
{
    const ec_rare_kind *kind;
    const double mean = e->mean_luminance, missing_light = ec_rare_missing(rare, sums->samples, mean, limit, &kind);
    double few = 0, rest = mean;
    for (uint32_t i = 0; i < sums->tail.count; i++) {
        few += sums->tail.largest[i] * sums->tail.largest[i];
        rest -= sums->tail.largest[i] / pixels;
    }
    e->missing_light = sqrt(missing_light) / mean;
    e->missing_light_samples = kind ? EC_RARE_MET / kind->chance / pixels : 0;
    e->bound_if_met = e->error_bound;
    e->tail_share = sums->s2 > 0 ? fmin(few / sums->s2, 1) : 0;
    e->is_open = EC_RARE_DOUBT * e->missing_light > e->error || (sqrt(missing_light) > EC_RARE_LEAST * rest && e->tail_share > EC_RARE_TAIL);
    if (kind) memcpy(e->through, kind->through, sizeof e->through), memcpy(e->light, kind->light, sizeof e->light);
    e->error_bound = e->is_open ? INFINITY : hypot(e->error_bound, EC_RARE_DOUBT * e->missing_light);
}

ec_film_error ec_film_error_of(const ec_error_sums *sums, double pixels, uint32_t replicates, const ec_rare *rare, double limit)
{
    ec_film_error result = {.error = INFINITY, .error_bound = INFINITY, .relmse = INFINITY};
    double n = replicates;
    if (n < 1) return result;
    double mean = result.mean_luminance = sums->luminance / pixels;
    if (n >= 2) result.relmse = sums->relative / (3 * pixels);
    if (n < 2 || !(mean > 0)) return result;
    double square = sums->s2 / pixels / (mean * mean);
    result.error = sqrt(square);
    result.error_bound = 0;
    if (square != 0) {
        result.noisy_pixels = effective_pixels(sums, n, pixels);
        /* Var(s^2) = E[s^4] - v^2; with n < 4 that of normal pixels. */
        double variance = n >= 4 ? fmax(sums->s4 - sums->v4, 0) : sums->s4 * 2 / (n + 1);
        result.spread = sqrt(variance) / sums->s2;
        result.bright_samples = bright_samples(sums);
        result.larger = larger_samples(sums, &result.larger_falls);
        result.error_bound = ec_film_error_bound(square, result.noisy_pixels, result.bright_samples, result.larger, pixels, n);
    }
    judge(sums, pixels, rare, limit, &result);
    return result;
}

ec_film_error ec_film_look_at_error(const ec_film *film, ec_error_sums *sums)
{
    const uint32_t replicates = ec_film_replicates(film);
    *sums = (ec_error_sums){0};
    if (replicates) ec_film_sum_errors(film, sums);
    return ec_film_error_of(sums, (double)film->width * film->height, replicates, film->rare, film->limit);
}

ec_film_error ec_film_estimate_error(const ec_film *film)
{
    ec_error_sums sums;
    return ec_film_look_at_error(film, &sums);
}
