/* Fits an exposure by golden-section search around the best value of a coarse scale. */
#include "image/shown.h"

enum { PIXELS_MOST = 1 << 16, STOPS = 12 };

/* Returns the squared misfit over evenly spread pixels, which suffice for a single number. */
static double misfit(const ec_look *curve, double exposure, const ec_measured *linear, const ec_measured *shown)
{
    const ec_look look = {.tonemap = curve->tonemap, .exposure = exposure};
    uint64_t pixels = (uint64_t)linear->width * linear->height, step = pixels / PIXELS_MOST + 1;
    double sum = 0;
    for (uint64_t p = 0; p < pixels; p += step) {
        if (!ec_counts(linear, shown, p)) continue;
        float rgb[3];
        ec_show(&look, linear->rgb + 3 * p, 1, rgb);
        for (uint64_t c = 0; c < 3; c++) sum += ((double)rgb[c] - shown->rgb[3 * p + c]) * ((double)rgb[c] - shown->rgb[3 * p + c]);
    }
    return sum;
}

double ec_fit_exposure(const ec_look *look, const ec_measured *linear, const ec_measured *shown)
{
    const double golden = (sqrt(5) - 1) / 2;
    double best = 0, least = misfit(look, 0, linear, shown);
    for (double stops = -STOPS; stops <= STOPS; stops += 0.5) {
        double found = misfit(look, stops, linear, shown);
        if (found < least) least = found, best = stops;
    }
    double from = best - 0.5, to = best + 0.5;
    while (to - from > 1e-5) {
        double a = to - golden * (to - from), b = from + golden * (to - from);
        if (misfit(look, a, linear, shown) < misfit(look, b, linear, shown)) to = b;
        else from = a;
    }
    return (from + to) / 2;
}
