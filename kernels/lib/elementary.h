/* The few transcendental functions that the renderer needs, as polynomials: wide on every device, and the same bits on every
 * device that rounds as IEEE 754 asks. */
#ifndef EC_LIB_ELEMENTARY_H
#define EC_LIB_ELEMENTARY_H

#include "lanes.h"

#define EC_PI 3.14159265358979f
#define EC_INV_PI 0.318309886183791f

/* sin and cos of 2 pi u for u in [0, 1]: quadrant, then Taylor polynomials on [-pi/4, pi/4]; error below 2 ulp of 1. */
EC_FN lane_f sincos_2pi(lane_f u, lane_f *cosine)
{
    lane_f q = floor(fma(u, F(4.0f), F(0.5f)));
    lane_f r = fma(u, F(4.0f), -q) * 1.57079632679490f; /* u * 4 is exact */
    lane_i quadrant = to_lane_i(q);
    lane_f r2 = r * r;
    lane_f s = fma(r2, F(2.7557319e-6f), F(-1.9841270e-4f));
    s = fma(s, r2, F(8.3333333e-3f));
    s = fma(s, r2, F(-1.6666667e-1f));
    s = fma(s * r2, r, r);
    lane_f c = fma(r2, F(2.4801587e-5f), F(-1.3888889e-3f));
    c = fma(c, r2, F(4.1666667e-2f));
    c = fma(c, r2, F(-0.5f));
    c = fma(c, r2, F(1.0f));
    lane_i swap = (quadrant & 1) != 0;
    lane_f a = swap ? c : s, b = swap ? s : c;
    lane_u sign_s = (int_to_lane_u(quadrant) & 2u) << 30;
    lane_u sign_c = (int_to_lane_u(quadrant + 1) & 2u) << 30;
    *cosine = as_lane_f(as_lane_u(b) ^ sign_c);
    return as_lane_f(as_lane_u(a) ^ sign_s);
}

/* exp(x) for x <= 0: 2^n exp(r), |r| <= ln 2 / 2, Taylor to the seventh power; error below 2 ulp, 0 under 2^-126. */
EC_FN lane_f exp_negative(lane_f x)
{
    lane_f n = floor(fma(x, F(1.44269504f), F(0.5f)));
    lane_f r = fma(n, F(-1.42860677e-6f), fma(n, F(-0.693145752f), x)); /* ln 2 in two parts (Cody & Waite) */
    lane_f p = fma(r, F(1.98412698e-4f), F(1.38888889e-3f));
    p = fma(p, r, F(8.33333333e-3f));
    p = fma(p, r, F(4.16666667e-2f));
    p = fma(p, r, F(1.66666667e-1f));
    p = fma(p, r, F(0.5f));
    p = fma(p, r, F(1.0f));
    p = fma(p, r, F(1.0f));
    lane_f scale = as_lane_f(int_to_lane_u((to_lane_i(max(n, F(-126.0f))) + 127) << 23));
    return n < -126.0f ? F(0.0f) : p * scale;
}

/* Returns ln x for x in (0, 1]. Its complement y = 1 - x has the digits where x is near 1. Splits x into exponent and mantissa m in [sqrt 1/2,
 * sqrt 2), with ln m = 2 atanh((m - 1) / (m + 1)) by its series; error below 4 ulps. Denormals count as 2^-126. */
EC_FN lane_f log_unit(lane_f x, lane_f y)
{
    lane_u bits = as_lane_u(max(x, F(1.17549435e-38f))) - 0x3f3504f3u; /* less the bits of sqrt 1/2, where m begins */
    lane_i power = uint_to_lane_i(bits) >> 23;
    lane_f m = as_lane_f((bits & 0x007fffffu) + 0x3f3504f3u);
    lane_f s = (power == 0 ? -y : m - 1.0f) / (m + 1.0f), s2 = s * s;
    lane_f p = fma(s2, F(0.222222222f), F(0.285714286f));
    p = fma(p, s2, F(0.4f));
    p = fma(p, s2, F(0.666666667f));
    return fma(int_to_lane_f(power), F(0.693147181f), fma(p * s2, s, 2.0f * s));
}

/* Returns atan2(y, x) / (2 pi) in [-0.5, 0.5]; 0 for (0, 0). atan t on [0, 1] is t + t^3 q(t^2), with a relative error below 2.5e-8 before rounding.
 * The unit is a turn, since quarters and halves of it are exact. */
EC_FN lane_f atan2_over_2pi(lane_f y, lane_f x)
{
    lane_f ax = fabs(x), ay = fabs(y);
    lane_f hi = max(ax, ay), lo = min(ax, ay);
    lane_f t = hi > 0.0f ? lo / hi : F(0.0f);
    lane_f t2 = t * t;
    lane_f q = fma(t2, F(-0.00238699722f), F(0.0135077713f));
    q = fma(q, t2, F(-0.0358715393f));
    q = fma(q, t2, F(0.0625016913f));
    q = fma(q, t2, F(-0.0865688026f));
    q = fma(q, t2, F(0.110337645f));
    q = fma(q, t2, F(-0.142785683f));
    q = fma(q, t2, F(0.199997395f));
    q = fma(q, t2, F(-0.333333313f));
    lane_f turns = fma(q * t2, t, t) * (0.5f * EC_INV_PI);
    turns = ay > ax ? 0.25f - turns : turns;
    turns = x < 0.0f ? 0.5f - turns : turns;
    return copysign(turns, y);
}

#endif
