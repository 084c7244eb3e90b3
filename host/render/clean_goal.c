/* The squared error of a denoised picture falls as samples^-slope. A denoiser's bias falls more slowly than noise: slopes of SLOPE are typical before two
 * looks tell, and stray by DEVIATION after that, as those of a picture that goes from bias to noise. */
#include "render/clean_goal.h"

#include <math.h>

#define SLOPE 0.7
#define SLOPE_LEAST 0.2
#define SLOPE_MOST 1.3
#define DEVIATION 0.25 /* of its logarithm */
#define FASTEST 2.0 /* slope */

bool ec_clean_goal_is_due(const ec_clean_goal *g, double samples, double target)
{
    if (!(g->samples > 0) || samples >= 2 * g->samples) return true;
    return g->now.high95 * pow(g->samples / samples, FASTEST / 2) <= target;
}

void ec_clean_goal_take(ec_clean_goal *g, double samples, const ec_clean_look *look)
{
    g->last_samples = g->samples;
    g->last = g->now;
    g->samples = samples;
    g->now = *look;
}

static double slope_of(const ec_clean_goal *g)
{
    if (!(g->last_samples > 0) || !(g->now.error > 0) || !(g->last.error > 0)) return SLOPE;
    return fmin(fmax(2 * log(g->last.error / g->now.error) / log(g->samples / g->last_samples), SLOPE_LEAST), SLOPE_MOST);
}

static double samples_by(const ec_clean_goal *g, double target, double slope)
{
    return g->samples * pow(fmax(g->now.high95 / target, 1), 2 / slope);
}

ec_clean_range ec_clean_goal_samples(const ec_clean_goal *g, double target)
{
    const double slope = slope_of(g), apart = exp(1.96 * DEVIATION);
    if (!(g->samples > 0) || !isfinite(g->now.high95)) return (ec_clean_range){INFINITY, INFINITY, INFINITY};
    return (ec_clean_range){samples_by(g, target, slope * apart), samples_by(g, target, slope), samples_by(g, target, slope / apart)};
}

double ec_clean_goal_bound(const ec_clean_goal *g, double samples)
{
    return g->samples > 0 ? g->now.high95 * pow(g->samples / fmax(samples, g->samples), slope_of(g) / 2) : INFINITY;
}
