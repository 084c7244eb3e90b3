/* Sampling a bilinear patch: the density at (x, y) of the unit square is proportional to a bilinear function that is not negative, times a
 * linear function of y. First y by its marginal density, a product of two linear functions whose integral is a cubic; then x, whose density
 * at that y is linear. */
#ifndef EC_LIB_PATCH_H
#define EC_LIB_PATCH_H

#include "math.h"

/* Samples a linear density that goes from a to b by u in [0, 1): solves (b - a) / 2 t^2 + a t = u (a + b) / 2 in the form that does not cancel (Press
 * et al., 5.6). Returns the middle where both are 0. */
EC_FN lane_f patch_across(lane_f a, lane_f b, lane_f u)
{
    lane_f most = max(a, b);
    a = a / most; /* squares stay in range */
    b = b / most;
    lane_f root = a + sqrt(fma(b * b - a * a, u, a * a)), t = u * (a + b) / root;
    t = root > 0.0f ? min(t, F(1.0f)) : F(0.0f); /* u = a = 0 */
    return most > 0.0f ? t : F(0.5f);
}

/* Samples the density (a (1 - t) + b t) (c (1 - t) + d t) by u. The linear density between its ends is never further off than 0.12 of the
 * integral; three of Newton's steps from there leave 4e-7 (2 million random patches, c : d from 0 to 1). */
EC_FN lane_f patch_along(lane_f a, lane_f b, lane_f c, lane_f d, lane_f u)
{
    lane_f most = max(a, b), least = max(c, d);
    a = a / most;
    b = b / most;
    c = c / least;
    d = d / least;
    lane_f p0 = a * c, p1 = 0.5f * fma(a, d, b * c), p2 = b * d; /* in Bernstein's basis */
    lane_f slope = p1 - p0, bend = (p0 - p1) + (p2 - p1), goal = u * ((p0 + p1 + p2) * (1.0f / 3.0f));
    lane_f t = patch_across(p0, p2, u);
    for (int step = 0; step < 3; step++) {
        lane_f density = fma(t, fma(t, bend, 2.0f * slope), p0);
        lane_f excess = fma(t, fma(t, fma(t, bend * (1.0f / 3.0f), slope), p0), -goal);
        t = min(max(density > 0.0f ? t - excess / density : t, F(0.0f)), F(1.0f));
    }
    return most > 0.0f ? t : F(0.5f);
}

#endif
