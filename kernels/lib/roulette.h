/* Russian roulette. */
#ifndef EC_LIB_ROULETTE_H
#define EC_LIB_ROULETTE_H

#include "math.h"

#define EC_SURVIVAL_LEAST 0.00390625f
#define EC_SURVIVAL_MOST 0.95f

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
