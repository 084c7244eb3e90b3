/* A clear coat over a surface (KHR_materials_clearcoat): GGX microfacets of index 1.5 with a normal of their own. What the coat
 * reflects, by Fresnel at its own normal, the surface under it does not get:
 *
 *   f = (1 - s) base + s D V,   s = weight (0.04 + 0.96 (1 - n . wo)^5)
 *
 * The same factor dims what the surface under it emits. Light is not dimmed again on its way back: energy is kept, but f(wo, wi) is not f(wi, wo). */
#ifndef EC_LIB_COAT_H
#define EC_LIB_COAT_H

#include "fresnel.h"
#include "ggx.h"
#include "surface.h"

typedef struct coat {
    lane_f share; /* s: reflectance of the coat along wo, times its weight */
    lane_f p;     /* probability of sampling it */
    ggx facets;
    v3 s, t, n;   /* its frame, local to the surface's */
    v3 wo;        /* in that frame */
} coat;

EC_FN v3 coat_local(const coat *c, v3 w)
{
    return v3_make(v3_dot(w, c->s), v3_dot(w, c->t), v3_dot(w, c->n));
}

/* Fresnel reflectance of the coat at this cosine to its normal. */
EC_FN lane_f coat_reflectance(lane_f cosine)
{
    return fma(pow5(1.0f - min(max(cosine, F(0.0f)), F(1.0f))), F(0.96f), F(0.04f));
}

/* Returns what the surface at h emits towards wo, dimmed by its coat. Paths that meet a lamp and light samples on one both go by this. Bodies of
 * glass have no coat on the inside, even where a texture says that nothing passes. */
EC_FN v3 coat_emission(const geometry *g, const hit_point *h, lane_i m, v3 wo, v3 emission)
{
    if (!HAS(CLEARCOAT)) return emission;
    m = m & (material_quad(g, h, EC_WORD_coat).a > 0.0f);
    if (!any_lane(m)) return emission;
    surface s;
    surface_place(h, wo, &s);
    surface_frame(g, h, m, wo, &s);
    lane_u flags = as_lane_u(material_quad(g, h, EC_WORD_emission).d);
    m = m & (s.front | ((flags & (EC_MATERIAL_REFRACTS | EC_MATERIAL_BOUNDS)) == 0u));
    lane_f share = surface_coat_weight(g, h, m) * coat_reflectance(v3_dot(s.coat_ns, wo));
    return v3_select(m, v3_scale(emission, 1.0f - share), emission);
}

/* albedo: approximate albedo of the surface under the coat. */
EC_FN coat coat_make(const surface *s, v3 wo, lane_f albedo)
{
    coat c;
    c.facets = ggx_make(s->coat_alpha, s->coat_smooth, F(1.0f));
    c.n = v3_make(F(0.0f), F(0.0f), F(1.0f));
    if (HAS_BENDING) {
        v3 away = v3_sub(s->coat_ns, s->ns);
        lane_i tilted = v3_dot(away, away) > 0.0f;
        c.n = v3_select(tilted, v3_normalize(surface_to_local(s, s->coat_ns)), c.n);
    }
    v3_frame(c.n, &c.s, &c.t);
    c.wo = coat_local(&c, wo);
    c.share = s->coat * coat_reflectance(c.wo.z);
    lane_f under = (1.0f - c.share) * albedo;
    /* At most 0.9: the surface under the coat may matter at other angles. */
    c.p = c.share > 0.0f ? min(c.share / (c.share + under), F(0.9f)) : F(0.0f);
    return c;
}

/* Lays the coat over *f (f |cos wi|) and *pdf of the surface under it. */
EC_FN void coat_over(const coat *c, v3 wi_local, v3 *f, lane_f *pdf)
{
    lane_i coated = c->share > 0.0f;
    if (!any_lane(coated)) return;
    v3 wi = coat_local(c, wi_local), sum = v3_add(c->wo, wi), h = v3_scale(sum, 1.0f / sqrt(v3_dot(sum, sum)));
    lane_i above = coated & (wi_local.z > 0.0f) & (wi.z > 0.0f) & (c->wo.z > 0.0f) & !c->facets.smooth;
    lane_f d = 0.5f * ggx_d(&c->facets, h), lambda_o = ggx_lambda(&c->facets, c->wo), lambda_i = ggx_lambda(&c->facets, wi);
    lane_f value = above ? c->share * d * wi.z / fma(wi.z, lambda_o, c->wo.z * lambda_i) : F(0.0f);
    lane_f density = above ? c->p * d / (c->wo.z + lambda_o) : F(0.0f);
    *f = v3_add(v3_scale(*f, 1.0f - c->share), v3_splat(value));
    *pdf = fma(1.0f - c->p, *pdf, density);
}

/* Samples a direction mirrored at one of the coat's facets, local to the surface. */
EC_FN v3 coat_sample(const coat *c, lane_f cosine, lane_f sine, lane_f u2)
{
    v3 m = ggx_sample(&c->facets, c->wo, cosine, sine, u2), wi = v3_fma(m, 2.0f * v3_dot(c->wo, m), v3_negate(c->wo));
    v3 local_wi = v3_fma(c->n, wi.z, v3_fma(c->t, wi.y, v3_scale(c->s, wi.x)));
    local_wi.z = wi.z > 0.0f ? max(local_wi.z, F(0.0f)) : F(0.0f); /* below the coat or the surface: no direction */
    return local_wi;
}

#endif
