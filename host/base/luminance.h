/* Relative luminance of linear Rec.709 colour (IEC 61966-2-1); the weights sum to 1. */
#ifndef EC_BASE_LUMINANCE_H
#define EC_BASE_LUMINANCE_H

static inline double ec_luminance(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

static inline double ec_luminance_of_floats(const float rgb[3])
{
    return ec_luminance((double[3]){rgb[0], rgb[1], rgb[2]});
}

#endif
