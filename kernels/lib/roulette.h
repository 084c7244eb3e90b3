/* Russian roulette. */
#ifndef EC_LIB_ROULETTE_H
#define EC_LIB_ROULETTE_H

#include "math.h"

#define EC_SURVIVAL_LEAST 0.00390625f
#define EC_SURVIVAL_MOST 0.95f

/* Probability that a path goes on whose throughput's largest component this is; constant > 0: that one instead. Of random numbers of
 * 24 bits no fewer than one in 2^24 can be let through: a throughput of 1e-12 would be divided by that and survive 60 000 times as
 * often. So there is a least one, far enough above. */
EC_FN lane_f roulette_survival(lane_f brightest, float constant_survival)
{
    return constant_survival > 0.0f ? F(constant_survival) : min(max(brightest, F(EC_SURVIVAL_LEAST)), F(EC_SURVIVAL_MOST));
}

#endif
