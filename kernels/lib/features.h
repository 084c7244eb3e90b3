/* First-hit features into the slots of a wave. */
#ifndef EC_LIB_FEATURES_H
#define EC_LIB_FEATURES_H

#include "lanes.h"
#include "math.h"

EC_FN void store_features(global float *aov, uint wave, lane_u slot, v3 albedo, v3 n, lane_f depth, lane_f alpha, uint bits)
{
    scatter_f(aov, slot, albedo.x, bits);
    scatter_f(aov + wave, slot, albedo.y, bits);
    scatter_f(aov + 2 * wave, slot, albedo.z, bits);
    scatter_f(aov + 3 * wave, slot, n.x, bits);
    scatter_f(aov + 4 * wave, slot, n.y, bits);
    scatter_f(aov + 5 * wave, slot, n.z, bits);
    scatter_f(aov + 6 * wave, slot, depth, bits);
    scatter_f(aov + 7 * wave, slot, alpha, bits);
}

#endif
