/* Positions near the edges of their triangle, where a path may else leave through the wall next to it. */
#ifndef EC_LIB_INSET_H
#define EC_LIB_INSET_H

#include "geometry.h"

/* Takes a position off its triangle's edges, or to its middle. Where two walls share an edge, a point on one of them may else be rounded to
 * behind the other, or come so close that traversal cannot tell on which side a ray starts: 8 u of the way to the other's corners (edges_least),
 * which may be 32 times as long as this triangle. n: its edges' cross product. */
#define EC_INSET_OF_PLACE (16.0f * EC_ULP)
#define EC_INSET_OF_EDGES (256.0f * EC_ULP)
EC_FN v3 surface_inset(const hit_point *h, v3 n, v3 p)
{
    v3 e1 = v3_sub(h->p1, h->p0), e2 = v3_sub(h->p2, h->p0);
    lane_f base2 = 2.0f * (v3_dot(e1, e1) + v3_dot(e2, e2)), n2 = v3_dot(n, n); /* no edge is longer than base */
    lane_f inset2 = fma(base2, F(EC_INSET_OF_EDGES * EC_INSET_OF_EDGES), v3_dot(h->p0, h->p0) * (EC_INSET_OF_PLACE * EC_INSET_OF_PLACE));
    lane_f least = min(h->b0, min(h->b1, h->b2)); /* of the least height, n / base */
    lane_i near = least * least * n2 < inset2 * base2;
    if (!any_lane(near)) return p;
    lane_f share = min(sqrt(inset2 * base2 / n2), F(0.25f));
    lane_f b0 = max(h->b0, share), b1 = max(h->b1, share), b2 = max(h->b2, share), part = 1.0f / (b0 + b1 + b2);
    b1 *= part;
    b2 *= part;
    v3 inner = v3_fma(h->p2, b2, v3_fma(h->p1, b1, v3_scale(h->p0, 1.0f - b1 - b2)));
    return v3_select(near, inner, p);
}

#endif
