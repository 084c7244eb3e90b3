/* Lane-wide vectors. */
#ifndef EC_LIB_MATH_H
#define EC_LIB_MATH_H

#include "elementary.h"

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
/* Returns a b - c d within 1.5 ulps: what one product rounds off is put back (Kahan; Jeannerod, Louvet, Muller 2013). It is subtracted, not added, so
 * that a zero keeps its sign. */
EC_FN lane_f product_difference(lane_f a, lane_f b, lane_f c, lane_f d)
{
    lane_f cd = c * d;
    return fma(a, b, -cd) - fma(c, d, -cd);
}
EC_FN v3 v3_cross(v3 a, v3 b)
{
    return v3_make(product_difference(a.y, b.z, a.z, b.y), product_difference(a.z, b.x, a.x, b.z),
                   product_difference(a.x, b.y, a.y, b.x));
}
EC_FN v3 v3_select(lane_i m, v3 a, v3 b) { return v3_make(m ? a.x : b.x, m ? a.y : b.y, m ? a.z : b.z); }
EC_FN lane_f v3_max_component(v3 a) { return max(a.x, max(a.y, a.z)); }
EC_FN lane_f luminance(v3 a) { return fma(a.x, F(0.2126f), fma(a.y, F(0.7152f), a.z * 0.0722f)); } /* Rec. 709 */
EC_FN float luminance_one(float r, float g, float b) { return fma(r, 0.2126f, fma(g, 0.7152f, b * 0.0722f)); }
EC_FN v3 v3_normalize(v3 a) { return v3_scale(a, 1.0f / sqrt(v3_dot(a, a))); }

EC_FN bool is_finite_one(float x) { return (as_uint(x) & 0x7f800000u) != 0x7f800000u; }
EC_FN lane_i is_finite_bits(lane_f x) { return (as_lane_u(x) & 0x7f800000u) != 0x7f800000u; }
EC_FN lane_i v3_is_finite(v3 a) { return is_finite_bits(a.x) & is_finite_bits(a.y) & is_finite_bits(a.z); }

/* Makes an orthonormal frame around the unit vector n (Duff et al. 2017, listing 3, but with its change of sign at n.z = -0.125 instead of 0: there
 * an ulp of a vertex would turn the frame of an axis-parallel wall, and of all paths that leave it). */
EC_FN void v3_frame(v3 n, v3 *s, v3 *t)
{
    lane_f sign = n.z < -0.125f ? F(-1.0f) : F(1.0f);
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
