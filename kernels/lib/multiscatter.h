/* Gives back what single scattering at GGX microfacets loses (--scattering multiple). What meets a second facet is counted as lost: l(n . w) of white
 * light along w (multiscatter_table.h). A lobe with the shape of the loss in both directions returns it (Kulla and Conty 2017, "Revisiting physically
 * based shading at Imageworks"):
 *
 *   f = share l(no) l(ni) / (pi L),   L = integral of 2 mu l(mu) over mu
 *
 * so that along each wo it returns share l(no), whatever the table says; and that says no more than was lost: a furnace stays at 1 or under it. The
 * lobe is reciprocal. For metal, share is F^2 E / (1 - F (1 - E)) with F the mean of Schlick's reflectance and E = 1 - L. Rough glass loses what
 * neither its reflection nor its transmission brings; of that, 1 - t comes back and t passes. Between bodies, whose loss depends on the side, f keeps
 * n^2's reciprocity (bsdf.h) because t L of one side is eta^2 t L of the other. */
#ifndef EC_LIB_MULTISCATTER_H
#define EC_LIB_MULTISCATTER_H

#include "../shared/features.h"
#include "math.h"
#include "multiscatter_table.h"

#define MULTISCATTER_ROW (MULTISCATTER_COSINES + 1)
#define MULTISCATTER_SIDE (MULTISCATTER_ROUGHNESSES * MULTISCATTER_ROW)

/* One side of a surface: its place in the table. */
typedef struct loss {
    lane_u at;                  /* index of the first value of its row */
    lane_f roughness, contrast; /* fractions towards the next row and towards the next contrast */
} loss;

/* Returns the node before place p among `count`; *behind: the fraction from there to the next. */
EC_FN lane_u loss_node(lane_f p, uint count, lane_f *behind)
{
    lane_f node = min(max(floor(p), F(0.0f)), F((float)(count - 2u)));
    *behind = min(max(p - node, F(0.0f)), F(1.0f));
    return int_to_lane_u(to_lane_i(node));
}

/* eta: index beyond over index here; 0: everything is mirrored. */
EC_FN loss loss_make(lane_f alpha, lane_f eta)
{
    loss l;
    lane_f contrast = (eta - 1.0f) / (eta + 1.0f), place = sqrt(fabs(contrast)) * (0.5f * (float)(MULTISCATTER_CONTRASTS - 1));
    lane_u row = loss_node(sqrt(alpha) * (float)(MULTISCATTER_ROUGHNESSES - 1), MULTISCATTER_ROUGHNESSES, &l.roughness);
    lane_u side = loss_node(0.5f * (float)(MULTISCATTER_CONTRASTS - 1) + (contrast < 0.0f ? -place : place),
                            MULTISCATTER_CONTRASTS, &l.contrast);
    l.at = side * MULTISCATTER_SIDE + row * MULTISCATTER_ROW;
    return l;
}

/* Interpolates along a row (t: the fraction after `column`), between rows and, with TRANSMISSION, between contrasts. */
EC_FN lane_f loss_look_up(const loss *l, lane_u column, lane_f t)
{
    lane_f value = F(0.0f);
    for (uint k = 0; k < (HAS(TRANSMISSION) ? 2u : 1u); k++) {
        lane_u at = l->at + column + k * MULTISCATTER_SIDE, next = at + MULTISCATTER_ROW;
        lane_f low = fma(t, gather_constant_f(multiscatter_table, at + 1u), (1.0f - t) * gather_constant_f(multiscatter_table, at));
        lane_f high = fma(t, gather_constant_f(multiscatter_table, next + 1u),
                          (1.0f - t) * gather_constant_f(multiscatter_table, next));
        lane_f row = fma(l->roughness, high, (1.0f - l->roughness) * low);
        value = k ? fma(l->contrast, row, (1.0f - l->contrast) * value) : row;
    }
    return value;
}

/* Returns l for the cosine of a direction on this side. */
EC_FN lane_f loss_along(const loss *l, lane_f cosine)
{
    lane_f t;
    lane_u column = loss_node(sqrt(cosine) * (float)(MULTISCATTER_COSINES - 1), MULTISCATTER_COSINES, &t);
    return loss_look_up(l, column, t);
}

/* Returns L. */
EC_FN lane_f loss_mean(const loss *l) { return loss_look_up(l, U(MULTISCATTER_COSINES), F(0.0f)); }

/* Returns the share for a channel f0 of metal; mean: L. f is the mean of Schlick's reflectance. */
EC_FN lane_f loss_share(lane_f f0, lane_f mean)
{
    lane_f f = fma(1.0f - f0, F(1.0f / 21.0f), f0);
    return f * f * (1.0f - mean) / (1.0f - f * mean);
}

typedef struct multiscatter {
    loss metal, here, beyond;          /* here, beyond: the two sides of glass */
    v3 of_metal, back, through;        /* f / l(wi) of metal, and of glass on either side */
    lane_f albedo;                     /* share of grey light that it returns */
    lane_f p, p_below;                 /* probability of sampling the lobe; then, of the other side */
    lane_f slope;                      /* of the sampling density in z, from 1 - slope to 1 + slope */
} multiscatter;

/* metallic, glass: shares of the surface. Where the reflectance of glass is not that of its index, the table does not hold, and callers pass a
 * smaller share. Thin walls, which do not refract, mirror what passes and lose what metal does. */
EC_FN multiscatter multiscatter_make(lane_f alpha, lane_f cosine, v3 base, lane_f metallic, lane_f glass, lane_f eta,
                                     lane_i refracts)
{
    multiscatter m;
    m.metal = loss_make(alpha, F(0.0f));
    m.of_metal = m.back = m.through = v3_zero();
    m.p = m.p_below = F(0.0f);
    m.slope = alpha;
    m.here = m.beyond = m.metal;
    lane_f mean = loss_mean(&m.metal), own = loss_along(&m.metal, cosine), lobe = mean > 0.0f ? EC_INV_PI * own / mean : F(0.0f);
    v3 share = v3_scale(v3_make(loss_share(base.x, mean), loss_share(base.y, mean), loss_share(base.z, mean)), metallic);
    m.of_metal = v3_scale(share, lobe);
    m.albedo = own * luminance(share);
    if (!HAS(TRANSMISSION)) return m;
    m.here = loss_make(alpha, refracts ? eta : F(0.0f));
    m.beyond = loss_make(alpha, refracts ? 1.0f / eta : F(0.0f));
    lane_f far = loss_mean(&m.beyond), r = (eta - 1.0f) / (eta + 1.0f), enters = (20.0f / 21.0f) * fma(-r, r, F(1.0f));
    mean = loss_mean(&m.here);
    own = loss_along(&m.here, cosine);
    lane_i loses = mean > 0.0f;
    lane_f across = refracts ? eta * eta * far : mean, passes = enters * (loses ? min(across / mean, F(1.0f)) : F(0.0f));
    m.back = v3_splat(loses ? glass * (1.0f - passes) * own / mean * EC_INV_PI : F(0.0f));
    m.through = v3_scale(base, (loses & (far > 0.0f)) ? glass * passes * own / far * EC_INV_PI : F(0.0f));
    lane_f through = glass * passes * own * luminance(base);
    m.albedo = fma(glass * (1.0f - passes), own, m.albedo) + through;
    m.p_below = through > 0.0f ? min(max(through / m.albedo, F(0.1f)), F(0.9f)) : F(0.0f); /* at other angles each may matter more */
    return m;
}

/* Sets the probability of sampling the lobe. albedo: about what facets return by single scattering. */
EC_FN void multiscatter_weigh(multiscatter *m, lane_f albedo)
{
    m->p = m->albedo > 0.0f ? m->albedo / (m->albedo + albedo) : F(0.0f);
}

/* Adds the lobe to f |cos wi| and the density of single scattering. Its own density over either hemisphere is uniform for narrow lobes, which lose
 * most near the horizon, and goes by the cosine for the widest. */
EC_FN void multiscatter_over(const multiscatter *m, v3 wo, v3 wi, v3 *f, lane_f *pdf)
{
    lane_i any = (m->p > 0.0f) & (wo.z > 0.0f);
    if (!any_lane(any)) return;
    lane_f z = min(fabs(wi.z), F(1.0f)), share = wi.z > 0.0f ? 1.0f - m->p_below : F(0.0f);
    v3 more = v3_scale(m->of_metal, loss_along(&m->metal, z));
    if (HAS(TRANSMISSION)) {
        more = v3_fma(m->back, loss_along(&m->here, z), more);
        more = v3_select(wi.z < 0.0f, v3_scale(m->through, loss_along(&m->beyond, z)), more);
        share = wi.z < 0.0f ? m->p_below : share;
    }
    *f = v3_select(any & (share > 0.0f), v3_fma(more, z, *f), *f);
    *pdf = any ? fma(1.0f - m->p, *pdf, m->p * share * (0.5f * EC_INV_PI) * fma(m->slope, 2.0f * z - 1.0f, F(1.0f))) : *pdf;
}

/* Samples a direction with the density of multiscatter_over, from an angle and u2; below: on the other side, as p_below has chosen. */
EC_FN v3 multiscatter_sample(const multiscatter *m, lane_f cosine, lane_f sine, lane_f u2, lane_i below)
{
    lane_f least = 1.0f - m->slope, root = sqrt(fma(least, least, 4.0f * m->slope * u2));
    lane_f z = min(u2 > 0.0f ? 2.0f * u2 / (least + root) : F(0.0f), F(1.0f)); /* solves slope z^2 + (1 - slope) z = u2 */
    lane_f r = sqrt(max(fma(-z, z, F(1.0f)), F(0.0f)));
    return v3_make(r * cosine, r * sine, below ? -z : z);
}

#endif
