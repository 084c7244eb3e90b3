/* Ray against box and ray against triangle: the only definition of what a hit is. Every structure and layout uses these
 * functions, so that all give the same hits bit for bit: packets put one ray in each lane and splat the triangle, the wide
 * BVH splats the ray and puts one triangle in each lane.
 *
 * Leaves hold references: a triangle and a box, its own or, where the builder has cut it, that of one part; the boxes of all
 * its references together hold it. A reference is hit at t_R = max(t, near_R), t being the triangle's distance and near_R, far_R
 * where the ray enters and leaves the reference's box, if near_R <= far_R. The answer is the least t_R of all references,
 * of equal ones that of the least triangle id.
 *
 * Why culling can never change it: every box above a reference holds the reference's box, and is computed with the same
 * monotone arithmetic. It therefore is entered no later than near_R <= t_R, and left no sooner than far_R.
 * Why it is right: the hit lies in one of the triangle's boxes, and there t_R is t itself. Boxes before it give t as well,
 * boxes behind it something larger, and it is the least that counts. */
#ifndef EC_LIB_RAY_H
#define EC_LIB_RAY_H

#include "math.h"

typedef struct ray {
    v3 o, d;      /* d need not be unit: t is in units of its length */
    /* Slabs: t of a plane is fma(plane, inverse, offset); offsets are widened by the error bound, outwards. */
    v3 inverse, lo_offset, hi_offset;
    /* Shear that makes d the z axis (Woop, Benthin, Wald 2013): z is d's largest component. */
    lane_i z_is_x, z_is_y;
    v3 o_permuted;
    lane_f shear_x, shear_y, scale_z;
} ray;

/* Exchanges the largest component of d with z. (Not the cyclic order of the paper: this one costs a third less.) */
EC_INLINED v3 ray_permute(lane_i z_is_x, lane_i z_is_y, v3 v)
{
    return v3_make(z_is_x ? v.z : v.x, z_is_y ? v.z : v.y, z_is_x ? v.x : (z_is_y ? v.y : v.z));
}

/* scene_max: largest |coordinate| of the scene. */
EC_INLINED ray ray_make(v3 o, v3 d, float scene_max)
{
    ray r;
    r.o = o;
    r.d = d;
    v3 ad = v3_abs(d);
    lane_f d_max = v3_max_component(ad);
    /* A component under 2^-60 of the largest counts as that: the reciprocal stays finite and no 0 * inf arises. */
    lane_f d_min = d_max * 8.6736174e-19f;
    r.inverse = v3_make(copysign(1.0f / max(ad.x, d_min), d.x), copysign(1.0f / max(ad.y, d_min), d.y),
                        copysign(1.0f / max(ad.z, d_min), d.z));
    /* Rounding of vertices and origins in the shear moves a triangle by at most this (Woop et al. 2013, section 3.3, with
     * one bound for all axes). */
    lane_f bound = (v3_max_component(v3_abs(o)) + scene_max) * (16.0f * EC_ULP);
    v3 widen = v3_scale(r.inverse, bound);
    v3 offset = v3_make(-(o.x * r.inverse.x), -(o.y * r.inverse.y), -(o.z * r.inverse.z));
    r.lo_offset = v3_sub(offset, widen); /* widen has the sign of d: the lo plane is the near one where d > 0 */
    r.hi_offset = v3_add(offset, widen);

    r.z_is_x = (ad.x >= ad.y) & (ad.x >= ad.z);
    r.z_is_y = !r.z_is_x & (ad.y >= ad.z);
    v3 p = ray_permute(r.z_is_x, r.z_is_y, d);
    r.o_permuted = ray_permute(r.z_is_x, r.z_is_y, o);
    r.scale_z = 1.0f / p.z;
    r.shear_x = p.x * r.scale_z;
    r.shear_y = p.y * r.scale_z;
    return r;
}

#define EC_SLAB_PAD 1.0000005f /* 1 + 8 u: relative rounding of reciprocal, product and sum */

/* Entry and padded exit distances; the box is met within [0, t_max] where near <= far. */
EC_INLINED lane_f slab_near(const ray *r, v3 lo, v3 hi, lane_f t_max, lane_f *far)
{
    lane_f x0 = fma(lo.x, r->inverse.x, r->lo_offset.x), x1 = fma(hi.x, r->inverse.x, r->hi_offset.x);
    lane_f y0 = fma(lo.y, r->inverse.y, r->lo_offset.y), y1 = fma(hi.y, r->inverse.y, r->hi_offset.y);
    lane_f z0 = fma(lo.z, r->inverse.z, r->lo_offset.z), z1 = fma(hi.z, r->inverse.z, r->hi_offset.z);
    *far = min(min(max(x0, x1), max(y0, y1)), min(max(z0, z1), t_max)) * EC_SLAB_PAD;
    return max(max(min(x0, x1), min(y0, y1)), max(min(z0, z1), F(0.0f)));
}

/* Vertices in the ray's frame and the three edge functions. */
typedef struct edges {
    lane_f u, v, w, det;  /* twice the signed areas opposite to vertices 0, 1, 2; their sum */
    lane_f z0, z1, z2;    /* unscaled depths of the vertices */
} edges;

/* A vertex in the ray's frame: x and y sheared, z the unscaled depth. v: permuted vertex minus permuted origin. */
EC_INLINED v3 ray_shear(lane_f shear_x, lane_f shear_y, v3 v)
{
    return v3_make(fma(-shear_x, v.z, v.x), fma(-shear_y, v.z, v.y), v.z);
}

EC_INLINED v3 ray_vertex(const ray *r, v3 p)
{
    return ray_shear(r->shear_x, r->shear_y, v3_sub(ray_permute(r->z_is_x, r->z_is_y, p), r->o_permuted));
}

/* Returns the edge function, whose sign says on which side of the edge from q to p the ray passes. Products are rounded one by one and compared: the
 * sign is never wrong, only sometimes 0, and seen from the other side it is exactly the negative (Woop et al. 2013). */
EC_INLINED lane_f ray_edge(v3 p, v3 q) { return p.x * q.y - p.y * q.x; }

/* Returns the lanes whose ray passes inside, and sets e->det. 0 counts as inside, so no ray slips between two triangles. */
EC_INLINED lane_i edges_inside(edges *e)
{
    e->det = e->u + e->v + e->w;
    return ((min(e->u, min(e->v, e->w)) >= 0.0f) | (max(e->u, max(e->v, e->w)) <= 0.0f)) & (e->det != 0.0f);
}

/* a, b, c: sheared vertices. */
EC_INLINED edges edges_make(v3 a, v3 b, v3 c)
{
    edges e = {ray_edge(c, b), ray_edge(a, c), ray_edge(b, a), F(0.0f), a.z, b.z, c.z};
    return e;
}

/* Returns the t up to which a hit does not count. Below the rounding of the vertices' depths, and of a mean of these, the sign of t means nothing: a
 * face in the plane that a ray starts on is not met (pbrt-v4, section 6.8.7, delta_t). */
EC_INLINED lane_f edges_least(lane_f z0, lane_f z1, lane_f z2) { return max(fabs(z0), max(fabs(z1), fabs(z2))) * (8.0f * EC_ULP); }

/* Returns which of the lanes m meet their triangle's plane in front of them, at t <= t_max, as far as floats can tell; *inverse = 1 / det. *close:
 * those that edges_settle must decide, returned whatever their t; reference_clamp compares it with t_max. */
EC_INLINED lane_i edges_distance(const ray *r, const edges *e, lane_i m, lane_f t_max, lane_i *close, lane_f *inverse, lane_f *t)
{
    lane_f z0 = e->z0 * r->scale_z, z1 = e->z1 * r->scale_z, z2 = e->z2 * r->scale_z;
    *inverse = 1.0f / e->det;
    *t = fma(e->u, z0, fma(e->v, z1, e->w * z2)) * *inverse;
    lane_i is_short = *t <= edges_least(z0, z1, z2);
    *close = m & is_short & (max(z0, max(z1, z2)) > 0.0f); /* a mean of negative depths is negative */
    return *close | (m & !is_short & (*t <= t_max));
}

/* Returns the rounding error of sum = a + b (Knuth's two-sum). */
EC_INLINED lane_f sum_error(lane_f a, lane_f b, lane_f sum)
{
    lane_f of_b = sum - a;
    return (a - (sum - of_b)) + (b - of_b);
}

/* Returns the rounding error of ray_edge: the errors of its products and of their difference. */
EC_INLINED lane_f ray_edge_error(v3 p, v3 q, lane_f edge)
{
    lane_f a = p.x * q.y, b = p.y * q.x;
    return (fma(p.x, q.y, -a) - fma(p.y, q.x, -b)) + sum_error(a, -b, edge);
}

/* Returns the sum of u z0, v z1 and w z2 with twice a float's digits (Ogita, Rump, Oishi 2005, algorithm 5.3), for u, v, w before their rounding. */
EC_INLINED lane_f edges_exact_sum(const edges *e, v3 a, v3 b, v3 c, lane_f z0, lane_f z1, lane_f z2)
{
    lane_f p0 = e->u * z0, p1 = e->v * z1, p2 = e->w * z2, first = p0 + p1, sum = first + p2;
    lane_f lost = sum_error(p0, p1, first) + sum_error(first, p2, sum);
    lost += fma(e->u, z0, -p0) + fma(e->v, z1, -p1) + fma(e->w, z2, -p2);
    v3 p = c, q = b, r = a;
    lane_f edge = e->u, z = z0;
    EC_LOOP
    for (uint k = 0; k < 3; k++) {
        lost = fma(ray_edge_error(p, q, edge), z, lost);
        v3 last = q;
        q = p, p = r, r = last; /* c b, a c, b a */
        edge = k ? e->w : e->v, z = k ? z2 : z1;
    }
    return sum + lost;
}

/* Returns t of close triangles, negative where they are not met. Where t is short, the edge functions' rounding hides what is in front of the origin
 * and what is behind it: each product is at most `most`, so each of the three functions is off by 4 u most, and their sum with the depths by three
 * times that and its own roundings, in all 32 u most times the greatest depth. Along needles this may be any t. Then twice the digits decide.
 * Vertices are rounded the same way for all triangles around them, so a closed mesh stays closed. a, b, c: sheared vertices. */
EC_INLINED lane_f edges_settle(const ray *r, const edges *e, v3 a, v3 b, v3 c, lane_i close, lane_f inverse, lane_f t)
{
    lane_f z0 = e->z0 * r->scale_z, z1 = e->z1 * r->scale_z, z2 = e->z2 * r->scale_z, least = edges_least(z0, z1, z2);
    lane_f most = max(fabs(a.x), max(fabs(b.x), fabs(c.x))) * max(fabs(a.y), max(fabs(b.y), fabs(c.y)));
    lane_i hidden = close & (fabs(t) <= most * least * fabs(inverse) * 4.0f);
    t = close ? F(-1.0f) : t;
    if (!any_lane(hidden)) return t;
    lane_f exact = edges_exact_sum(e, a, b, c, z0, z1, z2) * inverse;
    return (hidden & (exact > least)) ? exact : t;
}

/* Returns the lanes whose ray meets the triangle, its box left aside. The traversals do the same step by step. */
EC_INLINED lane_i ray_meets(const ray *r, v3 v0, v3 v1, v3 v2, edges *e, lane_f *inverse, lane_f *t)
{
    v3 a = ray_vertex(r, v0), b = ray_vertex(r, v1), c = ray_vertex(r, v2);
    *e = edges_make(a, b, c);
    lane_i inside = edges_inside(e), close, m = edges_distance(r, e, inside, F(EC_HUGE), &close, inverse, t);
    *t = edges_settle(r, e, a, b, c, close, *inverse, *t);
    return m & (*t > 0.0f);
}

/* Clamps *t to the slab of the reference's box; returns false where the box is missed or *t is past t_max. */
EC_INLINED lane_i reference_clamp(const ray *r, v3 lo, v3 hi, lane_f t_max, lane_f *t)
{
    lane_f far, near = slab_near(r, lo, hi, F(EC_HUGE), &far);
    *t = max(*t, near);
    return (near <= far) & (*t <= t_max);
}

/* Returns the lanes that see the triangle's front (counter-clockwise). Exchanging two axes mirrors the triangle. */
EC_INLINED lane_i edges_front(const ray *r, const edges *e)
{
    lane_i is_mirrored = r->z_is_x | r->z_is_y, same = (e->det < 0.0f) == (r->scale_z < 0.0f);
    return is_mirrored ? !same : same;
}

#endif
