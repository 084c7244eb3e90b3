#include "film/clamp.h"

#include <math.h>

#include "film/pixel.h"

ec_cut ec_film_cut(const ec_film *film, uint64_t pixel)
{
    float tail[3] = {0};
    const double n = ec_film_samples(film, pixel);
    ec_film_tail(film, pixel, tail);
    if (!(film->limit > 0) || !(n > 0)) return (ec_cut){0};
    const double unit = (double)tail[0] * (double)tail[0] / (double)film->limit; /* shared/params.h */
    const double sum = unit * (double)tail[1], squares = unit * unit * (double)tail[2];
    const double se2 = n > 1 ? fmax(squares - sum * sum / n, 0) / (n * (n - 1)) : 0;
    return (ec_cut){sum / n, se2};
}

void ec_film_sum_cut(const ec_film *film, ec_cut_sums *sums)
{
    const uint64_t pixels = (uint64_t)film->width * film->height;
    for (uint64_t p = 0; film->limit > 0 && p < pixels; p++) {
        const ec_cut cut = ec_film_cut(film, p);
        sums->mean += cut.mean;
        sums->square += cut.mean * cut.mean;
        sums->se2 += cut.se2;
    }
}

/* Returns the standard error of cut / (cut + kept), to first order. Ignores that both rise together, which would make it smaller. */
static double share_stderr(double cut, double cut_se, double kept, double kept_se)
{
    return hypot(kept * cut_se, cut * kept_se) / ((cut + kept) * (cut + kept));
}

ec_clamp_error ec_clamp_error_of(const ec_cut_sums *sums, const ec_film_error *noise, double pixels)
{
    const double cut = sums->mean / pixels, kept = noise->mean_luminance;
    ec_clamp_error e = {NAN, NAN, noise->error, NAN, NAN, NAN};
    if (!(kept > 0) || !isfinite(noise->error)) return e;
    e.missing = cut / (cut + kept);
    e.missing_stderr = share_stderr(cut, sqrt(sums->se2) / pixels, kept, noise->error * kept / sqrt(pixels));
    e.bias = sqrt(fmax(sums->square - sums->se2, 0) / pixels) / kept;
    e.bias_most = sqrt(sums->square / pixels) / kept;
    e.error = hypot(e.noise, e.bias);
    return e;
}

double ec_clamp_bias(const ec_clamp_error *error)
{
    return error->bias * error->bias < error->bias_most * error->bias_most / 2 ? error->bias_most : error->bias;
}

ec_clamp_error ec_film_clamp_error(const ec_film *film)
{
    ec_cut_sums sums = {0};
    const ec_film_error noise = ec_film_estimate_error(film);
    ec_film_sum_cut(film, &sums);
    return ec_clamp_error_of(&sums, &noise, (double)film->width * film->height);
}
