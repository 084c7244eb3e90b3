/* Lane-wide vectors and the few transcendental functions the renderer needs, as polynomials: wide on every device, and the
 * same bits on every device that rounds as IEEE 754 asks. */
#ifndef EC_LIB_MATH_H
#define EC_LIB_MATH_H

#include "lanes.h"

#define EC_PI 3.14159265358979f
#define EC_INV_PI 0.318309886183791f
#define EC_HUGE 3.0e38f
#define EC_ULP 5.9604645e-8f /* u = 2^-24: half an ulp of 1 */
/* gamma_n = n u / (1 - n u): relative error of n roundings (Higham 2002, section 3.1) */
#define EC_GAMMA(n) ((n) * EC_ULP / (1.0f - (n) * EC_ULP))

typedef struct v3 {
    lane_f x, y, z;
} v3;

EC_FN v3 v3_make(lane_f x, lane_f y, lane_f z)
{
    v3 r = {x, y, z};
    return r;
}
EC_FN v3 v3_splat(lane_f a) { return v3_make(a, a, a); }
EC_FN v3 v3_zero(void) { return v3_splat(F(0.0f)); }
EC_FN v3 v3_add(v3 a, v3 b) { return v3_make(a.x + b.x, a.y + b.y, a.z + b.z); }
EC_FN v3 v3_sub(v3 a, v3 b) { return v3_make(a.x - b.x, a.y - b.y, a.z - b.z); }
EC_FN v3 v3_mul(v3 a, v3 b) { return v3_make(a.x * b.x, a.y * b.y, a.z * b.z); }
EC_FN v3 v3_scale(v3 a, lane_f s) { return v3_make(a.x * s, a.y * s, a.z * s); }
EC_FN v3 v3_negate(v3 a) { return v3_make(-a.x, -a.y, -a.z); }
EC_FN v3 v3_abs(v3 a) { return v3_make(fabs(a.x), fabs(a.y), fabs(a.z)); }
/* a + s b */
EC_FN v3 v3_fma(v3 b, lane_f s, v3 a) { return v3_make(fma(b.x, s, a.x), fma(b.y, s, a.y), fma(b.z, s, a.z)); }
EC_FN lane_f v3_dot(v3 a, v3 b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }
EC_FN v3 v3_cross(v3 a, v3 b)
{
    return v3_make(fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x)));
}
EC_FN v3 v3_select(lane_i m, v3 a, v3 b) { return v3_make(m ? a.x : b.x, m ? a.y : b.y, m ? a.z : b.z); }
EC_FN lane_f v3_max_component(v3 a) { return max(a.x, max(a.y, a.z)); }
EC_FN lane_f luminance(v3 a) { return fma(a.x, F(0.2126f), fma(a.y, F(0.7152f), a.z * 0.0722f)); } /* Rec. 709 */
EC_FN v3 v3_normalize(v3 a) { return v3_scale(a, 1.0f / sqrt(v3_dot(a, a))); }

EC_FN lane_i is_finite_bits(lane_f x) { return (as_lane_u(x) & 0x7f800000u) != 0x7f800000u; }
EC_FN lane_i v3_is_finite(v3 a) { return is_finite_bits(a.x) & is_finite_bits(a.y) & is_finite_bits(a.z); }

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

/* ln x for x in (0, 1]: exponent and mantissa in [sqrt 1/2, sqrt 2), of which ln m = 2 atanh((m - 1) / (m + 1)) by its series;
 * error below 2 ulp. Denormals count as 2^-126. */
EC_FN lane_f log_unit(lane_f x)
{
    lane_u bits = as_lane_u(max(x, F(1.17549435e-38f))) - 0x3f3504f3u; /* sqrt 1/2: what is under it goes to the exponent */
    lane_f exponent = int_to_lane_f(uint_to_lane_i(bits) >> 23);
    lane_f m = as_lane_f((bits & 0x007fffffu) + 0x3f3504f3u);
    lane_f s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
    lane_f p = fma(s2, F(0.222222222f), F(0.285714286f));
    p = fma(p, s2, F(0.4f));
    p = fma(p, s2, F(0.666666667f));
    return fma(exponent, F(0.693147181f), fma(p * s2, s, 2.0f * s));
}

/* atan2 / (2 pi) in [-0.5, 0.5]; (0, 0) gives 0. Minimax polynomial of atan on [0, 1], error below 1e-6 / (2 pi). */
EC_FN lane_f atan2_over_2pi(lane_f y, lane_f x)
{
    lane_f ax = fabs(x), ay = fabs(y);
    lane_f hi = max(ax, ay), lo = min(ax, ay);
    lane_f t = hi > 0.0f ? lo / hi : F(0.0f);
    lane_f t2 = t * t;
    lane_f p = fma(t2, F(-0.0040545f), F(0.0218612f));
    p = fma(p, t2, F(-0.0559098f));
    p = fma(p, t2, F(0.0964200f));
    p = fma(p, t2, F(-0.1390853f));
    p = fma(p, t2, F(0.1994653f));
    p = fma(p, t2, F(-0.3332985f));
    p = fma(p, t2, F(0.9999993f));
    p = p * t;
    p = ay > ax ? 1.57079632679490f - p : p;
    p = x < 0.0f ? EC_PI - p : p;
    return copysign(p * (0.5f * EC_INV_PI), y);
}

/* acos(x) / pi for x in [-1, 1] through the half-angle form, which keeps its digits at both ends. */
EC_FN lane_f acos_over_pi(lane_f x)
{
    return fabs(atan2_over_2pi(sqrt(max((1.0f - x) * (1.0f + x), F(0.0f))), x)) * 2.0f;
}

/* Orthonormal frame around the unit vector n (Duff et al. 2017, listing 3, but for -0, which counts as 0: compilers differ about the
 * signs of zeros, and an axis-parallel n would turn its frame by them). */
EC_FN void v3_frame(v3 n, v3 *s, v3 *t)
{
    lane_f sign = n.z < 0.0f ? F(-1.0f) : F(1.0f);
    lane_f a = -1.0f / (sign + n.z);
    lane_f b = n.x * n.y * a;
    *s = v3_make(fma(sign * n.x * n.x, a, F(1.0f)), sign * b, -sign * n.x);
    *t = v3_make(b, fma(n.y * n.y, a, sign), -n.y);
}

/* Power heuristic w(a) = a^2 / (a^2 + b^2) in ratio form: neither square overflows (Veach 1997, 9.2.4). */
EC_FN lane_f mis_weight(lane_f a, lane_f b)
{
    lane_f r = b / a;
    return 1.0f / fma(r, r, F(1.0f));
}

#endif
