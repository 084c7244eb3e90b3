/* The metallic-roughness BSDF of glTF 2.0, appendix B, with KHR_materials_specular, _ior, _transmission, _volume and
 * _diffuse_transmission:
 *
 *   f = metallic F_m D V + (1 - metallic) (F_d D V + (1 - max F_d) ((1 - transmission) diffuse / pi + transmission base T))
 *
 * diffuse: base on wo's side, on the other the colour of diffuse transmission, in the shares 1 - t and t. From inside a body that is clear in part
 * the base lies before the face that reflects: transmission (F D V + (1 - F) base T) + (1 - transmission) diffuse / pi, otherwise light that is
 * totally reflected again and again would also be scattered each time. Under a thin film (iridescence.h) both F are the film's. D, V: of GGX
 * microfacets (ggx.h). T passes light on: through a thin wall by the same lobe mirrored, into a body by the microfacet BTDF of Walter et al. 2007,
 * eq. 21, between basic radiances L / n^2 (Nicodemus 1963), so that no factor n^2 comes and goes with each body. A smooth surface has one
 * direction of reflection and one of transmission: bsdf_eval leaves those out, since nothing but bsdf_sample finds them. Directions are local (z =
 * ns) and point away from the surface. Values include |cos wi|; pdfs are per solid angle. */
#ifndef EC_LIB_BSDF_H
#define EC_LIB_BSDF_H

#include "bsdf_eval.h"
#include "choice.h"

typedef struct bsdf_direction {
    v3 wi;
    v3 weight;  /* f |cos wi| / pdf */
    lane_f pdf; /* 0: no direction; < 0: the only one of its kind, which no other strategy finds */
} bsdf_direction;

/* Samples the reflected or the transmitted direction at a sampled microfacet; u in [0, 1] chooses which. The weight is that of a smooth surface. */
EC_FN bsdf_direction bsdf_sample_specular(const bsdf *b, lane_f cosine, lane_f sine, lane_f u2, lane_f u)
{
    bsdf_direction r;
    v3 m = ggx_sample(&b->facets, b->wo, cosine, sine, u2);
    lane_f om = v3_dot(b->wo, m);
    r.wi = v3_fma(m, 2.0f * om, v3_negate(b->wo));
    if (HAS(DIFFUSE_TRANSMISSION)) r.wi.z = max(r.wi.z, F(0.0f)); /* reflected below the surface: not to be taken for diffuse transmission */
    r.pdf = F(1.0f);
    r.weight = v3_zero();
    bool any_smooth = HAS(SMOOTH) && any_lane(b->facets.smooth);
    if (!HAS(TRANSMISSION) && !any_smooth) return r;
    lane_f rest;
    v3 reflectance = bsdf_fresnel(b, min(max(om, F(0.0f)), F(1.0f)), &rest);
    lane_f p_pass = F(0.0f), p_reflect = HAS(TRANSMISSION) ? bsdf_p_reflect(b, reflectance, rest, &p_pass) : F(1.0f);
    lane_i passes = (u >= p_reflect) & (p_pass > 0.0f);
    r.weight = v3_scale(reflectance, 1.0f / (p_reflect * b->p_specular));
    if (HAS(TRANSMISSION)) {
        v3 below = v3_select(b->refracts, refract(b->wo, m, b->eta), v3_make(r.wi.x, r.wi.y, -r.wi.z));
        r.wi = v3_select(passes, below, r.wi);
        v3 passed = v3_scale(b->base, rest * b->transmission / (p_pass * b->p_specular));
        r.weight = v3_select(passes, passed, r.weight);
        /* A tilted microfacet may lead to the wrong side: no direction, and no part of the densities. */
        r.wi.z = (passes ? r.wi.z < 0.0f : r.wi.z > 0.0f) ? r.wi.z : F(0.0f);
    }
    return r;
}

/* Samples without regard to the material: uniformly over the hemisphere about ns, or over the sphere where light passes. */
EC_FN v3 blind_sample(const bsdf *b, lane_f u1, lane_f u2, lane_f *pdf)
{
    lane_f cosine, sine = sincos_2pi(u1, &cosine), z = u2;
    *pdf = F(0.5f * EC_INV_PI);
    if (HAS_PASSING) {
        lane_i passes = (b->transmission > 0.0f) | (b->diffuse_transmission > 0.0f);
        z = passes ? fma(F(2.0f), u2, F(-1.0f)) : z;
        *pdf = passes ? F(0.25f * EC_INV_PI) : *pdf;
    }
    lane_f r = sqrt(max(fma(-z, z, F(1.0f)), F(0.0f)));
    return v3_make(r * cosine, r * sine, z);
}

/* Returns the probability that no single direction is sampled. */
EC_FN lane_f bsdf_p_spread(const bsdf *b)
{
    if (!HAS(SMOOTH)) return F(1.0f);
    lane_f p = b->facets.smooth ? 1.0f - b->p_specular : F(1.0f);
#define BSDF_P_SPREAD(feature, layer) \
    if (HAS(feature)) p = (1.0f - b->layer.p) * p + b->layer.p;
    LAYERS_UP(BSDF_P_SPREAD)
    if (HAS(CLEARCOAT)) p = (1.0f - b->coat.p) * p + (b->coat.facets.smooth ? F(0.0f) : b->coat.p);
    return p;
}

/* Samples a direction from u1 and `number`, which first chooses the lobe. u_pass chooses between reflection and transmission at a microfacet. blind:
 * uniform, except for what a smooth surface mirrors or lets pass. given: on these lanes the direction is wi, with the BSDF's density. */
EC_FN bsdf_direction bsdf_sample_or(const bsdf *b, bool blind, lane_f u1, chooser number, lane_f u_pass, lane_i given, v3 wi)
{
    bsdf_direction r;
    lane_i left = TRUE_MASK, by_coat = !TRUE_MASK, again = !TRUE_MASK, again_below = !TRUE_MASK;
    lane_i specular = !TRUE_MASK, sinks = !TRUE_MASK, single = !TRUE_MASK;
    const bool may_again = HAS(MULTISCATTER) && HAS(SPECULAR) && any_lane(b->again.p > 0.0f);
    if (HAS(CLEARCOAT)) {
        by_coat = choose(&number, left, b->coat.p);
        left = left & !by_coat;
    }
#define BSDF_CHOOSE(feature, layer)                      \
    lane_i by_##layer = !TRUE_MASK;                      \
    if (HAS(feature)) {                                  \
        by_##layer = choose(&number, left, b->layer.p);  \
        left = left & !by_##layer;                       \
    }
    LAYERS_DOWN(BSDF_CHOOSE)
    if (may_again) { /* p is 0 for smooth surfaces */
        again = choose(&number, left, b->again.p);
        if (HAS(TRANSMISSION)) again_below = choose(&number, again, b->again.p_below);
        left = left & !again;
    }
    if (HAS(SPECULAR)) {
        specular = choose(&number, left, b->p_specular);
        if (HAS(SMOOTH)) single = specular & b->facets.smooth;
        if (HAS(DIFFUSE_TRANSMISSION)) sinks = choose(&number, left & !specular, b->p_below);
    }
    lane_f u2 = chooser_end(&number), cosine, sine = sincos_2pi(u1, &cosine), root = sqrt(u2), blind_pdf = F(0.0f);
    r.wi = v3_make(root * cosine, root * sine, sqrt(max(1.0f - u2, F(0.0f))));
    if (HAS(DIFFUSE_TRANSMISSION)) r.wi.z = sinks ? -r.wi.z : r.wi.z;
    if (blind) {
        r.wi = blind_sample(b, u1, u2, &blind_pdf);
#define BSDF_UNCHOOSE(feature, layer) by_##layer = !TRUE_MASK;
        LAYERS_UP(BSDF_UNCHOOSE)
        again = !TRUE_MASK;
        specular = single;
    }
    v3 single_weight = v3_zero();
    if (HAS(SPECULAR) && any_lane(specular)) {
        bsdf_direction s = bsdf_sample_specular(b, cosine, sine, u2, u_pass);
        r.wi = v3_select(specular, s.wi, r.wi);
        single_weight = s.weight;
    }
    if (may_again) r.wi = v3_select(again, multiscatter_sample(&b->again, cosine, sine, u2, again_below), r.wi);
#define BSDF_SAMPLE(feature, layer)                                                                                       \
    if (HAS(feature)) {                                                                                                   \
        r.wi = v3_select(by_##layer, layer##_sample(&b->layer, b->wo, cosine, sine, u2), r.wi);                           \
        single_weight = v3_scale(single_weight, layer##_leaves(&b->layer, r.wi.z) / (1.0f - b->layer.p));                 \
    }
    LAYERS_UP(BSDF_SAMPLE)
    if (HAS(CLEARCOAT)) single_weight = v3_scale(single_weight, (1.0f - b->coat.share) / (1.0f - b->coat.p));
    if (HAS(CLEARCOAT) && any_lane(by_coat)) {
        lane_i mirrored = by_coat & b->coat.facets.smooth;
        v3 wi = coat_sample(&b->coat, cosine, sine, u2);
        r.wi = v3_select(blind ? mirrored : by_coat, wi, r.wi);
        single_weight = v3_select(mirrored, v3_splat(b->coat.share / b->coat.p), single_weight);
        single = by_coat ? mirrored & (r.wi.z > 0.0f) : single;
    }
    if (HAS(GUIDING)) {
        r.wi = v3_select(given, wi, r.wi);
        single = single & !given;
    }
    v3 f = bsdf_eval(b, r.wi, &r.pdf);
    if (blind) r.pdf = blind_pdf * bsdf_p_spread(b);
    r.weight = v3_scale(f, 1.0f / r.pdf);
    if (HAS(SMOOTH)) {
        r.weight = v3_select(single, single_weight, r.weight);
        r.pdf = single ? F(-1.0f) : r.pdf;
    }
    return r;
}
EC_FN bsdf_direction bsdf_sample(const bsdf *b, bool blind, lane_f u1, chooser number, lane_f u_pass)
{
    return bsdf_sample_or(b, blind, u1, number, u_pass, !TRUE_MASK, v3_zero());
}

#endif
