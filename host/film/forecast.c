#include "film/forecast.h"

#include <math.h>

double ec_outlook_bound(const ec_film_outlook *o, double batches)
{
    return ec_film_error_bound(o->variance / batches, o->noisy_pixels, o->pixels, batches);
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
