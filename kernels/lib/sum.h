/* The mean of a pixel's samples, in their order. */
#ifndef EC_LIB_SUM_H
#define EC_LIB_SUM_H

#include "math.h"

/* Adds 64 values at a time plainly, and these sums with compensation (Kahan 1965): plain floats gain or lose 6e-4 in 65536. */
EC_FN float sum_of(global const float *in, uint count, float scale)
{
    float sum = 0.0f, lost = 0.0f;
    for (uint first = 0; first < count; first += 64) {
        float part = 0.0f;
        for (uint s = first; s < min(first + 64, count); s++) part += in[s] * scale;
        float add = part - lost, next = sum + add;
        lost = (next - sum) - add;
        sum = next;
    }
    return sum;
}

EC_FN float mean_of(global const float *in, uint count)
{
    if (count == 1u) return 0.0f + in[0]; /* as the sum would, never -0 */
    float mean = sum_of(in, count, 1.0f) / (float)count;
    return is_finite_one(mean) ? mean : sum_of(in, count, 1.0f / (float)count); /* the sum is more than a float holds */
}

#endif
