/* A node's matrix that turns what is below it. */
#ifndef EC_TESTS_ROBUST_TILT_H
#define EC_TESTS_ROBUST_TILT_H

#include <math.h>

/* A tenth of a turn about a skew axis: no coordinate of what is in it stays round. */
static inline void tilt(double m[16])
{
    const double axis[3] = {0.36, 0.48, 0.8}, c = cos(0.6), s = sin(0.6);
    for (int k = 0; k < 16; k++) m[k] = k == 15;
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++) m[4 * column + row] = axis[row] * axis[column] * (1 - c) + (row == column ? c : 0);
    for (int k = 0; k < 3; k++) {
        m[4 * k + (k + 1) % 3] += s * axis[(k + 2) % 3];
        m[4 * ((k + 1) % 3) + k] -= s * axis[(k + 2) % 3];
    }
}

#endif
