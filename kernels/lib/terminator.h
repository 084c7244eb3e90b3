/* Rays that leave a faceted surface as if it were the smooth one that its vertex normals mean (Hanika 2021, "Hacking the shadow
 * terminator", Ray Tracing Gems II, chapter 4). Near the terminator a facet turns away from the light before the smooth surface
 * does, and shades itself. A ray that starts on the smooth surface, above the facet, passes over the horizon.
 *
 * Rays of all strategies start there, so that all see the same picture. Only where the surface bulges towards wo: a ray that
 * starts above its own facet and dips below its plane must still be stopped by it. Light that passes is not affected. */
#ifndef EC_LIB_TERMINATOR_H
#define EC_LIB_TERMINATOR_H

#include "surface.h"

/* Returns by how much the hit must rise, along a corner's normal, to reach the corner's tangent plane. */
EC_FN v3 terminator_rise(const geometry *g, const hit_point *h, const surface *s, lane_u vertex, v3 corner)
{
    v3 n = vertex_normal(g, h, vertex);
    n = v3_select(v3_dot(n, s->ng) < 0.0f, v3_negate(n), n);
    lane_f depth = v3_dot(v3_sub(corner, s->p), n), length2 = v3_dot(n, n);
    return v3_scale(n, ((depth > 0.0f) & (length2 > 0.0f)) ? depth / length2 : F(0.0f));
}

/* Returns where reflected rays and shadow rays start. *lifted: lanes on which that is above the facet by more than the rounding of the hit. */
EC_FN v3 terminator_origin(const geometry *g, const hit_point *h, const surface *s, lane_i *lifted)
{
    v3 rise = v3_scale(terminator_rise(g, h, s, h->i0, h->p0), h->b0);
    rise = v3_fma(terminator_rise(g, h, s, h->i1, h->p1), h->b1, rise);
    rise = v3_fma(terminator_rise(g, h, s, h->i2, h->p2), h->b2, rise);
    *lifted = v3_dot(rise, s->ng) > v3_dot(v3_abs(s->ng), s->p_error);
    return v3_select(*lifted, v3_add(s->p, rise), s->p);
}

#endif
