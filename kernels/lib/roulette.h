/* Russian roulette. By itself (--rr auto) a camera path goes on with the root of its throughput for probability: a gentler roulette than by the
 * throughput, which begins sooner. What goes through glass and off mirrors has most of its light before it, so there it begins later, as it does for
 * light paths. */
#ifndef EC_LIB_ROULETTE_H
#define EC_LIB_ROULETTE_H

#include "../shared/params.h"
#include "math.h"

#define EC_SURVIVAL_LEAST 0.00390625f
#define EC_SURVIVAL_MOST 0.95f
#define EC_ROULETTE_SHARP 5u /* segments that it spares there */

/* Is it played once a path has so many segments? is_late: of a light path, or where the next one's direction is the only one. */
EC_FN bool roulette_plays(constant ec_params *params, uint segments, bool is_late)
{
    return segments >= params->first_roulette && (!is_late || params->survival > 0.0f || segments >= EC_ROULETTE_SHARP);
}

/* Probability that a path goes on whose throughput's largest component this is; constant > 0: that one instead. A multiple of 2^-24,
 * so that it is to the last bit how often a random number, which has 24 bits, lies below. And far enough above the least of these: one
 * path in 2^24 that brings a picture's worth of light is noise without end. */
EC_FN lane_f roulette_survival(lane_f brightest, float constant_survival)
{
    lane_f survival = constant_survival > 0.0f ? F(constant_survival)
                                               : min(max(brightest, F(EC_SURVIVAL_LEAST)), F(EC_SURVIVAL_MOST));
    return ceil(survival * 16777216.0f) * 5.9604644775390625e-8f;
}

#endif
