/* Path guiding: samples directions where light is known to come from (Vorba et al. 2014; Mueller, Gross and Novak 2017). Light paths that are traced
 * before the picture record from where indirect light reaches which part of the scene. host/device/guide.c builds from them a tree of boxes, with an
 * equal-area quadtree of directions in each: x = (z + 1) / 2, y = the angle about z over 2 pi.
 *
 * At a surface a direction comes from the tree with some probability and from the BSDF otherwise, and has the density of the mixture, which MIS
 * weights use too. So the picture converges to the same result whatever the tree holds. */
#ifndef EC_LIB_GUIDE_H
#define EC_LIB_GUIDE_H

#include "../shared/guide.h"
#include "bsdf.h"
#include "surface.h"

#define EC_ROULETTE_SCALE_MOST 1e30f

typedef struct guide {
    global const float *table;
    lane_u root;   /* of the quadtree, in words */
    lane_f share;  /* probability that a direction comes from it, on lanes that are guided; else 0 */
} guide;

/* Finds the quadtree that guides directions at p, on the lanes m. */
EC_FN guide guide_find(global const float *table, lane_i m, v3 p)
{
    guide g = {table, U(0), F(0.0f)};
    lane_u at = U(0);
    for (lane_i going = m; any_lane(going);) {
        lane_f split = gather_f(table, at * EC_GUIDE_BOX_WORDS);
        lane_u link = as_lane_u(gather_f(table, at * EC_GUIDE_BOX_WORDS + 1u)), axis = link & 3u;
        lane_i ends = going & (axis == EC_GUIDE_LEAF);
        lane_f along = axis == 0u ? p.x : axis == 1u ? p.y : p.z;
        g.share = ends ? split : g.share;
        g.root = ends ? link >> 2 : g.root;
        going = going & !ends;
        at = going ? (link >> 2) + (along < split ? U(0) : U(1)) : at;
    }
    return g;
}

/* Likewise for surface b at p. Narrow lobes are left to the BSDF. */
EC_FN guide guide_at(global const float *table, lane_i m, v3 p, const bsdf *b)
{
    guide g = guide_find(table, m & !bsdf_is_single(b), p);
    lane_f wide = F(1.0f);
    if (HAS(SPECULAR)) wide = b->facets.alpha < EC_GUIDE_ALPHA ? 1.0f - b->p_specular : wide;
    if (HAS(CLEARCOAT)) wide *= 1.0f - b->coat.p;
    g.share *= wide;
    return g;
}

/* Returns the pdf per solid angle of the guide for w; 0 on lanes that are not guided. */
EC_FN lane_f guide_pdf(const guide *g, v3 w)
{
    lane_f pdf = F(0.25f * EC_INV_PI);
    lane_i going = g->share > 0.0f;
    if (!any_lane(going)) return F(0.0f);
    lane_f x = min(max(0.5f * w.z + 0.5f, F(0.0f)), F(EC_LAST_UNIT));
    lane_f turn = atan2_over_2pi(w.y, w.x);
    lane_f y = min(turn < 0.0f ? turn + 1.0f : turn, F(EC_LAST_UNIT));
    for (lane_u at = g->root; any_lane(going);) {
        lane_i right = x >= 0.5f, up = y >= 0.5f;
        lane_u quarter = at + (right ? U(2) : U(0)) + (up ? U(4) : U(0));
        lane_f share = gather_f(g->table, quarter);
        lane_u link = as_lane_u(gather_f(g->table, quarter + 1u));
        x = 2.0f * x - (right ? F(1.0f) : F(0.0f));
        y = 2.0f * y - (up ? F(1.0f) : F(0.0f));
        pdf = going ? pdf * 4.0f * share : pdf;
        going = going & (link != 0u) & (share > 0.0f);
        at = going ? link : at;
    }
    return g->share > 0.0f ? pdf : F(0.0f);
}

/* Samples a direction on the lanes m; u1, u2 in [0, 1). */
EC_FN v3 guide_sample(const guide *g, lane_i m, lane_f u1, lane_f u2)
{
    lane_f x = F(0.0f), y = F(0.0f), size = F(1.0f);
    lane_i going = m & (g->share > 0.0f);
    for (lane_u at = g->root; any_lane(going);) {
        quad first = gather_quad(g->table, at), second = gather_quad(g->table, at + 4u);
        quad shares = {first.a, first.c, second.a, second.c};
        lane_f p_left = shares.a + shares.c;
        lane_i right = (u1 >= p_left) & (shares.b + shares.d > 0.0f);
        lane_f low = right ? shares.b : shares.a, high = right ? shares.d : shares.c, p_low = low / (low + high);
        lane_i up = (u2 >= p_low) & (high > 0.0f);
        lane_f rest1 = right ? (u1 - p_left) / (1.0f - p_left) : u1 / p_left, rest2 = up ? (u2 - p_low) / (1.0f - p_low) : u2 / p_low;
        u1 = going ? min(max(rest1, F(0.0f)), F(EC_LAST_UNIT)) : u1;
        u2 = going ? min(max(rest2, F(0.0f)), F(EC_LAST_UNIT)) : u2;
        size = going ? 0.5f * size : size;
        x = (going & right) ? x + size : x;
        y = (going & up) ? y + size : y;
        lane_u link = as_lane_u(up ? (right ? second.d : second.b) : (right ? first.d : first.b));
        going = going & (link != 0u);
        at = going ? link : at;
    }
    x = fma(u1, size, x);
    y = fma(u2, size, y);
    lane_f z = 2.0f * x - 1.0f, r = sqrt(max(4.0f * x * (1.0f - x), F(0.0f))), cosine, sine = sincos_2pi(y, &cosine);
    return v3_make(r * cosine, r * sine, z);
}

/* Returns the density of the mixture of BSDF and guide. */
EC_FN lane_f guide_mix(const guide *g, lane_f pdf_bsdf, v3 w) 
{
    return fma(g->share, guide_pdf(g, w), (1.0f - g->share) * pdf_bsdf);
}

/* Samples the mixture of BSDF and guide as bsdf_sample does the BSDF. *wi: the direction in the world. *without: the weight that the sample would
 * have without the guide, over the one that it has. */
EC_FN bsdf_direction guide_sample_or(const guide *g, const surface *s, const bsdf *b, lane_f u1, chooser number, lane_f u_pass, v3 *wi, lane_f *without)
{
    lane_i by_guide = choose(&number, g->share > 0.0f, g->share);
    v3 guided = guide_sample(g, by_guide, u1, chooser_end(&number));
    bsdf_direction r = bsdf_sample_or(b, false, u1, number, u_pass, by_guide, surface_to_local(s, guided));
    *wi = surface_to_world(s, r.wi);
    lane_f mixed = guide_mix(g, r.pdf, *wi);
    lane_i single = r.pdf < 0.0f, is = r.pdf > 0.0f;
    lane_f scale = single ? 1.0f / (1.0f - g->share) : is ? r.pdf / mixed : F(1.0f);
    *without = min(is ? mixed / r.pdf : 1.0f / scale, F(EC_ROULETTE_SCALE_MOST));
    r.weight = v3_scale(r.weight, scale);
    r.pdf = is ? mixed : r.pdf;
    return r;
}

#endif
