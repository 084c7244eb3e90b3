#include "film/difference.h"

#include "film/film.h"

typedef struct sums {
    double luminance_a, luminance_b, square, luminance_square, relative_square, relative, largest;
    double noise_luminance, noise_relative;
    uint64_t pixels, unequal;
} sums;

/* Returns the variance of luminance; without se_y from the channels, as if their noise were one: never too little. */
static double luminance_variance(const ec_measured *image, uint64_t p)
{
    if (!image->se) return 0;
    double se = image->se_y ? image->se_y[p] : ec_luminance_of_floats(image->se + 3 * p);
    return se * se;
}

static void add_pixel(const ec_measured *a, const ec_measured *b, uint64_t p, sums *s)
{
    double ya = ec_luminance_of_floats(a->rgb + 3 * p), yb = ec_luminance_of_floats(b->rgb + 3 * p);
    int unequal = 0;
    s->luminance_a += ya;
    s->luminance_b += yb;
    s->luminance_square += (ya - yb) * (ya - yb);
    s->noise_luminance += luminance_variance(a, p) + luminance_variance(b, p);
    for (uint64_t i = 3 * p; i < 3 * p + 3; i++) {
        double x = a->rgb[i], r = b->rgb[i], d = x - r, floored = fabs(r) + EC_RELMSE_FLOOR;
        double sa = a->se ? a->se[i] : 0, sb = b->se ? b->se[i] : 0;
        unequal |= fabs(d) > ec_rounding(a, b, x, r) + ec_slack(a, b, i);
        s->square += d * d;
        s->relative_square += d * d / (floored * floored);
        s->relative += fabs(d) / floored;
        s->noise_relative += (sa * sa + sb * sb) / (floored * floored);
        s->largest = fmax(s->largest, r);
    }
    s->pixels++;
    s->unequal += (uint64_t)unequal;
}

ec_difference ec_measure_difference(const ec_measured *a, const ec_measured *b)
{
    sums s = {0};
    for (uint64_t p = 0; p < (uint64_t)a->width * a->height; p++)
        if (ec_counts(a, b, p)) add_pixel(a, b, p, &s);
    double n = (double)s.pixels, mean_b = s.luminance_b / n, mse = s.square / (3 * n), peak = b->peak > 0 ? b->peak : s.largest;
    int has_noise = a->se || b->se;
    return (ec_difference){
        .pixels = s.pixels,
        .unequal = s.unequal,
        .mean_a = s.luminance_a / n,
        .mean_b = mean_b,
        .rmse = sqrt(mse),
        .relative_rms = s.luminance_square > 0 ? sqrt(s.luminance_square / n) / mean_b : 0,
        .relmse = s.relative_square / (3 * n),
        .mape = s.relative / (3 * n),
        .psnr = mse == 0 ? INFINITY : peak > 0 ? 10 * log10(peak * peak / mse) : NAN,
        .noise_relative_rms = has_noise ? sqrt(s.noise_luminance / n) / mean_b : NAN,
        .noise_relmse = has_noise ? s.noise_relative / (3 * n) : NAN,
    };
}
