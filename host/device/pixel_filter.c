#include "device/pixel_filter.h"

#include <math.h>

/* Returns the window's distribution on [0, 1] (Harris 1978, table I: 92 dB). The window is positive at its ends, so that there is an inverse. */
static double distribution(double x)
{
    static const double a[4] = {0.35875, -0.48829, 0.14128, -0.01168};
    const double turn = 6.283185307179586477;
    double sum = x;
    for (int k = 1; k < 4; k++) sum += a[k] / a[0] * sin(turn * k * x) / (turn * k);
    return sum;
}

void ec_pixel_filter_blackman_harris(double width, float table[EC_FILTER_ENTRIES])
{
    for (int k = 0; k < EC_FILTER_ENTRIES; k++) {
        double low = 0, high = 0.5, share = 0.5 * pow((double)k / EC_FILTER_STEPS, 4);
        for (int i = 0; i < 60; i++) {
            double middle = 0.5 * (low + high);
            *(distribution(middle) < share ? &low : &high) = middle;
        }
        table[k] = (float)(width * (1 - 2 * (k < EC_FILTER_STEPS ? low : 0.5)));
    }
}
