/* Russian roulette. By default (--rr auto) a camera path survives with the root of its throughput as probability, which is gentler than the
 * throughput itself and begins sooner. Paths through glass and off mirrors have most of their light before them, so there it begins later, as it does
 * for light paths. */
#ifndef EC_LIB_ROULETTE_H
#define EC_LIB_ROULETTE_H

#include "../shared/params.h"
#include "math.h"

#define EC_SURVIVAL_LEAST 0.00390625f
#define EC_SURVIVAL_MOST 0.95f
#define EC_ROULETTE_SHARP 5u /* segments without roulette there */

/* Returns whether roulette is played after so many segments. is_late: for a light path, or where the next direction is the only one. */
EC_FN bool roulette_plays(constant ec_params *params, uint segments, bool is_late)
{
    return segments >= params->first_roulette && (!is_late || params->survival > 0.0f || segments >= EC_ROULETTE_SHARP);
}

/* Returns the probability that a path goes on, by `brightest`, the largest component of its throughput (for camera paths the root of that);
 * constant_survival > 0 takes its place. It is a multiple of 2^-24, so that it is to the last bit how often a random number, which has 24 bits, lies
 * below. And it is far enough above the least of these: one path in 2^24 that brings a picture's worth of light is noise without end. */
EC_FN lane_f roulette_survival(lane_f brightest, float constant_survival)
{
    lane_f survival = constant_survival > 0.0f ? F(constant_survival)
                                               : min(max(brightest, F(EC_SURVIVAL_LEAST)), F(EC_SURVIVAL_MOST));
    return ceil(survival * 16777216.0f) * 5.9604644775390625e-8f;
}

#endif
