#include "film/forecast.h"

#include <math.h>

#include "film/statistics.h"

double ec_outlook_bound(const ec_film_outlook *o, double batches)
{
    double square = o->variance / batches, nu = o->noisy_pixels;
    double from_pixels = ec_f_quantile(EC_BOUND_CONFIDENCE, nu, nu * fmax(batches - 1, 1)) - 1;
    double from_mean = 2 * ec_normal_upper_quantile(1 - EC_BOUND_CONFIDENCE) * sqrt(square / o->pixels);
    return sqrt(square * (1 + hypot(from_pixels, from_mean)));
}

double ec_outlook_batches(const ec_film_outlook *o, double target)
{
    double batches = fmax(o->variance / (target * target), 2);
    for (int i = 0; i < 20; i++) { /* the factor hardly depends on the number: a fixed point, soon found */
        double bound = ec_outlook_bound(o, batches), better = batches * bound * bound / (target * target);
        if (fabs(better - batches) < 1e-6 * batches) return better;
        batches = fmax(better, 2);
    }
    return batches;
}
