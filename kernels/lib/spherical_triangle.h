/* A triangle as a point sees it: solid angle, and directions uniform in it (Arvo 1995) as points of the triangle.
 *
 * a, b, c: unit vectors to the corners; D = |det(a, b, c)|, E = 1 + a.b + b.c + c.a. The solid angle is w = 2 atan2(D, E)
 * (van Oosterom and Strackee 1983), with D from the edge vectors and 1 + a.b as |a + b|^2 / 2: sums of angles less pi would
 * lose every digit of a small one. The part of it between a, b and a point of the arc a c has the area s where the arc is cut
 * at a^ x + c^ y with y = (1 + a.b) sin(s / 2) and x = y + sqrt(D^2 + E^2) sin((w - s) / 2), mirrored at that direction: no
 * arc cosine, nothing to clamp, and all weights are positive, so that no point lies outside.
 *
 * Right above it, at a height much less than its edges, the arc from b is all but a half circle, of which only rounding says where it
 * lies: directions are off by about u edge / height (0.04 at 2e-6). */
#ifndef EC_LIB_SPHERICAL_TRIANGLE_H
#define EC_LIB_SPHERICAL_TRIANGLE_H

#include "math.h"

#define EC_OPPOSITE 0.01f /* 1 + cosine: over 172 degrees apart */

typedef struct spherical_triangle {
    lane_f near_a, near_b, near_c; /* 1 / distance */
    lane_f h;               /* sqrt(D^2 + E^2) */
    lane_f ab, ac;          /* 1 + a.b, 1 + a.c */
    lane_f turns;           /* solid angle / 4 pi, at most a half; 0 also where it is not a number */
} spherical_triangle;

EC_FN lane_f half_square(v3 a) { return 0.5f * v3_dot(a, a); }

/* Returns E where a and b, not normalised, are nearly opposite, so that the point is next to the edge from a to b: sums of unit vectors would
 * leave nothing but their rounding. With q, the edge's nearest point, a = q + alpha (b - a) and b = q + beta (b - a); what cancels in |a| b + |b|
 * a and |a| |b| + a.b is then left out. */
EC_FN lane_f spherical_triangle_e(v3 a, v3 b, v3 c)
{
    v3 edge = v3_sub(b, a), x = v3_cross(a, edge);
    lane_f edge2 = v3_dot(edge, edge), x2 = v3_dot(x, x), inverse = 1.0f / edge2;
    lane_f la = sqrt(v3_dot(a, a)), lb = sqrt(v3_dot(b, b)), alpha = v3_dot(a, edge) * inverse, beta = v3_dot(b, edge) * inverse;
    v3 q = v3_scale(v3_cross(edge, x), inverse);
    v3 both = v3_fma(edge, x2 * inverse * (alpha + beta) / fma(beta, la, -alpha * lb), v3_scale(q, la + lb));
    return (x2 / fma(la, lb, -v3_dot(a, b)) + v3_dot(both, c) / sqrt(v3_dot(c, c))) / (la * lb);
}

/* Returns E where two of the corners are nearly opposite. Graphics cards branch: they have no registers to spare for a choice of nine numbers. */
EC_FN lane_f spherical_triangle_e_of(v3 a, v3 b, v3 c, lane_i is_ab, lane_i is_bc)
{
    if (LANES == 1) return is_ab ? spherical_triangle_e(a, b, c) : is_bc ? spherical_triangle_e(b, c, a) : spherical_triangle_e(c, a, b);
    return spherical_triangle_e(v3_select(is_ab, a, v3_select(is_bc, b, c)), v3_select(is_ab, b, v3_select(is_bc, c, a)),
                                v3_select(is_ab, c, v3_select(is_bc, a, b)));
}

/* a, b, c: corners seen from the point; det: |det(a, b, c)|, a times the cross product of two edges. */
EC_CALLED spherical_triangle spherical_triangle_make(v3 a, v3 b, v3 c, lane_f det)
{
    spherical_triangle t;
    t.near_a = 1.0f / sqrt(v3_dot(a, a));
    t.near_b = 1.0f / sqrt(v3_dot(b, b));
    t.near_c = 1.0f / sqrt(v3_dot(c, c));
    v3 unit_a = v3_scale(a, t.near_a), unit_b = v3_scale(b, t.near_b), unit_c = v3_scale(c, t.near_c), sum = v3_add(unit_a, unit_b);
    t.ab = half_square(sum);
    t.ac = half_square(v3_add(unit_a, unit_c));
    lane_f d = det * t.near_a * t.near_b * t.near_c, e = t.ab + v3_dot(sum, unit_c);
    lane_f bc = half_square(v3_add(unit_b, unit_c)), least = min(t.ab, min(t.ac, bc));
    if (any_lane(least < EC_OPPOSITE)) {
        lane_f safe = spherical_triangle_e_of(a, b, c, least == t.ab, least == bc);
        e = least < EC_OPPOSITE ? safe : e;
    }
    t.h = sqrt(fma(d, d, e * e));
    t.turns = atan2_over_2pi(d, e);
    t.turns = t.turns > 0.0f ? t.turns : F(0.0f); /* seen edge on; from a corner */
    return t;
}

/* Samples a unit direction from p; *weight_b, *weight_c: barycentrics, at the corners v1 and v2, of the point where it meets the triangle. */
EC_FN v3 spherical_triangle_sample(const spherical_triangle *t, v3 v0, v3 v1, v3 v2, v3 p, lane_f u1, lane_f u2, lane_f *weight_b,
                                   lane_f *weight_c)
{
    /* Unit vectors, computed again from p: compilers would otherwise keep those of spherical_triangle_make, for which a card has no registers. */
    v3 a = v3_scale(v3_sub(p, v0), -t->near_a), b = v3_scale(v3_sub(p, v1), -t->near_b), c = v3_scale(v3_sub(p, v2), -t->near_c);
    /* m: where the arc a c is cut. x is 1, so that no square underflows. */
    lane_f cosine, s = u1 * t->turns;
    lane_f y = t->ab * sincos_2pi(s, &cosine), d = t->h * sincos_2pi(t->turns - s, &cosine), scale = 1.0f / (y + d);
    y *= scale;
    d *= scale;
    lane_f length2 = 1.0f / fma(d, d, 2.0f * y * t->ac);
    lane_f ma = d * (1.0f + y) * length2, mc = 2.0f * y * fma(y, t->ac, d) * length2;
    v3 m = v3_fma(c, mc, v3_scale(a, ma));
    /* From b towards m, uniform in the cosine: its half angle's sine goes as the root. */
    lane_f sine = 0.5f * sqrt(v3_dot(v3_sub(m, b), v3_sub(m, b))), part = sqrt(u2) * sine;
    lane_f part_cosine = sqrt(max(fma(-part, part, F(1.0f)), F(0.0f)));
    cosine = sqrt(0.5f * half_square(v3_add(m, b)));
    lane_f pb = max(sine * part_cosine - part * cosine, F(0.0f)) * fma(cosine, part_cosine, sine * part);
    lane_f pm = part * part_cosine;
    /* A direction's weights over the unit vectors, times 1 / distance of each corner, are its point's weights over the corners. */
    lane_f wa = pm * ma * t->near_a, wb = pb * t->near_b, wc = pm * mc * t->near_c, sum = wa + wb + wc;
    lane_i valid = (sum > 0.0f) & is_finite_bits(sum);
    *weight_b = valid ? wb / sum : F(1.0f / 3.0f);
    *weight_c = valid ? wc / sum : F(1.0f / 3.0f);
    return v3_normalize(v3_fma(b, pb, v3_scale(m, pm)));
}

#endif
