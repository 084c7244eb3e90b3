/* The error of a denoised picture, from the render's own replicates.
 *
 * Setting. The film's replicates in two halves, a and b: independent pictures of the same truth m, whose pixels are independent too. A denoiser makes
 * D(a) and D(b) of them; the denoised picture is c = (D(a) + D(b)) / 2. All of what follows is of luminance, pixel by pixel.
 *
 * One half judges the other. With y_i = D(a) - b_i, b_i the n means of b's replicates, D(a) is a constant to b, so that
 *     U_b = mean over i != j of y_i y_j
 * has the expectation (D(a) - m)^2, whatever the distribution, and a sample far out enters it in the first power alone. It is (D(a) - b)^2 less the
 * estimated variance of b (the idea of Rousselle et al. 2012's and of cross-validation; Bitterli et al. 2016 filter halves across likewise).
 * And as c is the mean of two,
 *     (c - m)^2 = ((D(a) - m)^2 + (D(b) - m)^2) / 2 - ((D(a) - D(b)) / 2)^2,
 * of which the last term is known: `clean` is (U_b + U_a) / 2 less that, without bias for the very picture that there is. The last term is the
 * noise of c too: the variance of half the difference of two alike.
 *
 * How well is that known? To b the pixels' U_b are independent, so that variances add up over pixels. A pixel's is E[U^2] - E[U]^2, and for four
 * replicates or more the second is estimated without bias by the mean of products of four different y: v = U^2 - mean y_i y_j y_k y_l. With two or
 * three it is left out: the interval is then too wide. U_a and U_b go together as far as D's noise does: by -2 (D(a) - m)(b - m) and its mirror image,
 * for a linear filter whose weights are symmetric by 4 Var(D) Var(b), which is added as (D(a) - D(b))^2 times the halves' variance: no more than
 * the pixels' own part.
 *
 * Where one sample in hundreds brings the light of its pixel, as of a lamp within it, most renders have it in one replicate only: then no pair tells of
 * it, and v is near 0, or under it, just when U is too low. The plain variance 4 (D(a) - m)^2 Var b / n + 2 Var(b)^2 / (n (n - 1)), by estimates of its
 * terms and the variance of all replicates, sees it at once, but is too large wherever one sample makes both its terms. Over a picture v is mostly near
 * it; it is taken for PLAIN_LEAST of it at least, which decides where few pixels do.
 *
 * Estimates of squares are skewed to the right, so that the interval is as wide to both sides in the error itself: e +- z sd / (2 e), whose squares are
 * e^2 +- z sd + (z sd)^2 / (4 e^2). For a chi-square that is the term of second order of Cornish and Fisher (1938). Where the lower end is 0 the
 * quotient says no more of the upper one, which is then at e^2 + 3/2 z sd.
 *
 * What a blend gains (blend.c). The noisy picture is p = (a + b) / 2, and the product of both pictures' errors is (c - m)(p - m). D(a) follows a and knows
 * nothing of b, so that (D(a) - D(b)) (a - b) / 4 has its expectation, and no error of the denoiser's own in it: `gain` is Var p less that. Where D is as
 * good as constant, c - m = B and p - m = e, q = (B - e)^2 and what gain is of this picture, e^2 - B e, go together: less the estimate of Var p, by
 * 2 Var p (B^2 + Var p) but for the third moment. With q, with s for Var p and with an estimate of (Var p)^2 that is made of four different replicates,
 * 2 ((q - s) s + (Var p)^2 (n + 1) / (n - 1)) has that expectation, whatever the fourth moment is. The variance of q is twice that less 2 (Var p)^2.
 *
 * A denoiser's guides are of the samples of its half alone. With those of all samples D(a) knows something of b's noise, at edges above all: squared
 * errors of furnace/spheres were stated 14 % too low at 16 samples (100 seeds, 5.8 standard errors). */
#include "denoise/judge.h"

#include <math.h>
#include <string.h>

#include "film/pixel.h"
#include "film/statistics.h"
#include "film/threads.h"

#define PLAIN_LEAST 0.2 /* the variance is at least this share of the plain one */
#define SKEW_MOST 0.5   /* an interval of squares is shifted upwards by at most this part of its width */

/* Lists the replicates that have samples; returns how many there are. */
static uint32_t list_replicates(const ec_film *film, uint32_t list[EC_REPLICATES_MOST])
{
    uint32_t count = 0;
    for (uint32_t r = 0; r < film->replicates; r++)
        if (film->samples[r] > 0) list[count++] = r;
    return count;
}

/* Averages the replicates of a half, each weighted by its samples, which differ in a picture whose last batch was cut short. fields: floats a pixel,
 * 3 or 4. */
static void half_of_piece(const ec_film *film, uint32_t half, uint64_t first, uint64_t count, double scale, uint32_t fields, float *out)
{
    uint32_t list[EC_REPLICATES_MOST], used = 0;
    const uint32_t n = list_replicates(film, list);
    double mean[3 * EC_PIXELS] = {0}, one[3 * EC_PIXELS], y[EC_REPLICATES_MOST / 2 + 1][EC_PIXELS], samples = 0;
    for (uint32_t k = half; k < n; k += 2, used++) {
        samples += film->samples[list[k]];
        ec_film_replicate(film, first, count, list[k], one);
        for (uint64_t i = 0; i < 3 * count; i++) mean[i] += (one[i] - mean[i]) * film->samples[list[k]] / samples;
        for (uint64_t i = 0; i < count; i++) y[used][i] = scale * ec_luminance(&one[3 * i]);
    }
    for (uint64_t i = 0; i < count; i++) {
        float *to = out + fields * i;
        double squares = 0;
        for (uint64_t c = 0; c < 3; c++) to[c] = (float)(scale * mean[3 * i + c]);
        if (fields == 3) continue;
        for (uint32_t k = 0; k < used; k++) {
            const double apart = y[k][i] - ec_luminance_of_floats(to);
            squares += apart * apart;
        }
        to[3] = used > 1 ? (float)(squares / (used * (used - 1.0))) : 0;
    }
}

void ec_half(const ec_film *film, uint32_t half, float scale, uint32_t fields, float *out)
{
    const uint64_t pixels = (uint64_t)film->width * film->height;
#pragma omp parallel for if (ec_film_is_many(pixels))
    for (uint64_t first = 0; first < pixels; first += EC_PIXELS)
        half_of_piece(film, half, first, pixels - first < EC_PIXELS ? pixels - first : EC_PIXELS, (double)scale, fields, out + fields * first);
}

/* A value judged by a half's replicates: U, v and the plain variance, and the variance of the replicates' mean; spread: the variance of a replicate. */
typedef struct against {
    double square, variance, plain, mean, mean_variance;
} against;

static against judge_by(double value, const double *replicates, uint32_t n, double spread)
{
    double p1 = 0, p2 = 0, p3 = 0, p4 = 0, fourth = 0;
    for (uint32_t i = 0; i < n; i++) {
        const double y = value - replicates[i], y2 = y * y;
        p1 += y, p2 += y2, p3 += y2 * y, p4 += y2 * y2;
    }
    const double pairs = n * (n - 1.0), square = (p1 * p1 - p2) / pairs;
    if (n >= 4) /* by Newton's identities */
        fourth = (p1 * p1 * p1 * p1 - 6 * p1 * p1 * p2 + 3 * p2 * p2 + 8 * p1 * p3 - 6 * p4) / (pairs * (n - 2.0) * (n - 3.0));
    const double plain = 4 * fmax(square, 0) * spread / n + 2 * spread * spread / pairs;
    return (against){square, square * square - fourth, plain, value - p1 / n, (p2 - p1 * p1 / n) / pairs};
}

/* Returns the square of a replicate's variance, unbiased for any distribution: the mean of products of the squared differences of two pairs that have
 * none in common. */
static double square_of_variance(const double *y, uint32_t n, double mean)
{
    double p2 = 0, p4 = 0;
    for (uint32_t i = 0; i < n; i++) {
        const double square = (y[i] - mean) * (y[i] - mean);
        p2 += square, p4 += square * square;
    }
    return (p2 * p2 - p4 + 2 * (p2 * p2 - 2 * p4) / (n - 2.0) + 3 * (p2 * p2 - 2 * p4) / ((n - 2.0) * (n - 3.0))) / (n * (n - 1.0));
}

/* Judges one pixel. y: luminances of its replicates, one half after the other. */
static ec_judged judge(const double *y, uint32_t n, const float *a, const float *b)
{
    const uint32_t even = (n + 1) / 2, odd = n / 2;
    const double da = ec_luminance_of_floats(a), db = ec_luminance_of_floats(b), half = 0.5 * (da - db), clean = 0.5 * (da + db);
    const against all = judge_by(0, y, n, 0);
    const double spread = n * all.mean_variance;
    const against by_b = judge_by(da, y + even, odd, spread), by_a = judge_by(db, y, even, spread);
    const double together = 2 * half * half * (by_a.mean_variance + by_b.mean_variance);
    double mean = 0;
    for (uint32_t i = 0; i < n; i++) mean += y[i] / n;
    ec_judged j = {.luminance = mean, .clean = 0.5 * (by_b.square + by_a.square) - half * half, .noisy = all.mean_variance,
                   .apart = (clean - mean) * (clean - mean), .noise = half * half};
    j.clean_variance = 0.25 * (by_b.variance + by_a.variance) + together;
    j.clean_plain = 0.25 * (by_b.plain + by_a.plain) + together;
    const double shared = 0.5 * half * (by_a.mean - by_b.mean), of_shared = half * half * j.noisy;
    j.gain = j.noisy - shared;
    j.gain_plain = j.noisy * j.noisy + of_shared;
    const double fourth = square_of_variance(y, n, mean) / (n * n);
    j.gain_variance = j.noisy * j.noisy - fourth + of_shared;
    j.gain_apart = 2 * ((j.apart - j.noisy) * j.noisy + fourth * (n + 1) / (n - 1));
    j.apart_variance = 2 * j.gain_apart - 2 * fourth;
    j.noisy_variance = 2 * j.noisy * j.noisy * n / (n + 1); /* for normal pixels; E[s^4] exceeds v^2 by that much */
    return j;
}

static void judge_piece(const ec_film *film, uint64_t first, uint64_t count, const float *const denoised[2], ec_judged *out)
{
    uint32_t list[EC_REPLICATES_MOST];
    const uint32_t n = list_replicates(film, list), even = (n + 1) / 2;
    double y[EC_PIXELS][EC_REPLICATES_MOST], one[3 * EC_PIXELS];
    for (uint32_t k = 0; k < n; k++) {
        ec_film_replicate(film, first, count, list[k], one);
        for (uint64_t i = 0; i < count; i++) y[i][k % 2 ? even + k / 2 : k / 2] = ec_luminance(one + 3 * i);
    }
    for (uint64_t i = 0; i < count; i++) out[i] = judge(y[i], n, denoised[0] + 3 * (first + i), denoised[1] + 3 * (first + i));
}

void ec_judge_row(const ec_film *film, uint32_t row, const float *const denoised[2], ec_judged *out)
{
    for (uint32_t x = 0; x < film->width; x += EC_PIXELS)
        judge_piece(film, (uint64_t)row * film->width + x, film->width - x < EC_PIXELS ? film->width - x : EC_PIXELS, denoised, out + x);
}

/* States an error with its interval. The noisy picture's part of it reaches up as far as that picture's own bound, which takes account of few
 * pixels and bright samples. The mean luminance that all is divided by has an error of its own, as in film/image_error.c. An estimate that heavy
 * noise has made smaller than the noise that is known, or negative, is not believed: bias adds to that, and takes nothing off it. */
ec_stated_error ec_judged_state(const ec_judged_sum *sum, double pixels, const ec_film_error *noisy)
{
    const double mean = noisy->mean_luminance, unit = 1 / (mean * mean * pixels), square = fmax(sum->square, sum->least) * unit;
    const double z = ec_normal_upper_quantile(0.025);
    const double of_mean = 2 * noisy->error / sqrt(pixels) * square, times = noisy->error > 0 ? noisy->bound_if_met / noisy->error : 1;
    const double reach = z * hypot(sqrt(fmax(sum->variance, PLAIN_LEAST * sum->plain)) * unit, of_mean);
    const double shift = reach > 0 ? reach * fmin(reach / (4 * square), SKEW_MOST) : 0;
    const double up = hypot(shift + reach, sum->noisy * unit * (times * times - 1)), missing = EC_RARE_DOUBT * noisy->missing_light;
    ec_stated_error e = {sqrt(fmax(square, 0)), sqrt(fmax(square + shift - reach, 0)), sqrt(fmax(square + up, 0))};
    e.high95 = noisy->is_open || missing > e.error ? INFINITY : hypot(e.high95, missing);
    return e;
}
