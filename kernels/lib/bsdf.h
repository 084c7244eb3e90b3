/* The metallic-roughness BSDF of glTF 2.0, appendix B, with KHR_materials_specular, _ior, _transmission, _volume and
 * _diffuse_transmission:
 *
 *   f = metallic F_m D V + (1 - metallic) (F_d D V + (1 - max F_d) ((1 - transmission) diffuse / pi + transmission base T))
 *
 * diffuse: base on wo's side, on the other the colour of diffuse transmission, in the shares 1 - t and t.
 * From inside a body that is clear in part the base lies before the face that reflects: transmission (F D V + (1 - F) base T) +
 * (1 - transmission) diffuse / pi, or light that is reflected totally again and again would be scattered each time besides.
 * Under a thin film (iridescence.h) both F are the film's. D, V: of GGX microfacets (ggx.h). T passes light on: through a thin wall by the same
 * lobe mirrored, into a body by the microfacet BTDF of Walter et al. 2007, eq. 21, between basic radiances L / n^2 (Nicodemus
 * 1963), so that no factor n^2 comes and goes with each body. A smooth surface has one direction of reflection and one of
 * transmission: bsdf_eval leaves those out, since nothing but bsdf_sample finds them.
 * Directions are local (z = ns) and point away from the surface. Values include |cos wi|; pdfs are per solid angle. */
#ifndef EC_LIB_BSDF_H
#define EC_LIB_BSDF_H

#include "choice.h"
#include "coat.h"
#include "fresnel.h"
#include "ggx.h"
#include "iridescence.h"
#include "multiscatter.h"
#include "surface.h"

typedef struct bsdf {
    v3 wo;
    v3 base, f0;
    lane_f f90, metallic;
    ggx facets;
    lane_f p_specular;   /* probability of sampling what mirrors or passes, not the diffuse lobe */
    lane_f transmission, eta;
    lane_i refracts;
    lane_i base_first;   /* light gets to the base before the face that reflects */
    lane_f diffuse_transmission;        /* share of what is scattered diffusely that comes out on the other side */
    v3 transmission_color;           /* with this colour */
    lane_f p_below;      /* probability of that side, for the diffuse lobe */
    thin_film film;
    multiscatter again;  /* what facets scatter more than once */
#define BSDF_LAYER(feature, layer) layer layer;
    LAYERS_UP(BSDF_LAYER)
    coat coat;
} bsdf;

/* What a microfacet does with light, for the cosine between its normal and wo: reflectance, and the share of the rest that
 * goes to the base (diffusely, or passes). */
EC_FN v3 bsdf_fresnel(const bsdf *b, lane_f cosine, lane_f *rest)
{
    lane_f metal_rise = pow5(1.0f - cosine);
    lane_f rise = HAS(TRANSMISSION) ? fresnel_rise(cosine, b->eta, b->refracts) : metal_rise;
    v3 dielectric = v3_make(fma(b->f90 - b->f0.x, rise, b->f0.x), fma(b->f90 - b->f0.y, rise, b->f0.y),
                            fma(b->f90 - b->f0.z, rise, b->f0.z));
    /* Whatever a file says of the reflectance, no light gets out beyond the critical angle. */
    if (HAS(TRANSMISSION)) dielectric = v3_select(b->refracts & (rise == 1.0f), v3_splat(F(1.0f)), dielectric);
    v3 metal = v3_make(fma(1.0f - b->base.x, metal_rise, b->base.x), fma(1.0f - b->base.y, metal_rise, b->base.y),
                       fma(1.0f - b->base.z, metal_rise, b->base.z));
    lane_f left = 1.0f - min(v3_max_component(dielectric), F(1.0f));
    if (HAS(IRIDESCENCE) && any_lane(b->film.weight > 0.0f)) {
        lane_f w = b->film.weight;
        film_light l = film_light_make(&b->film, cosine, b->eta, b->refracts);
        v3 over = film_reflectance(&l, b->f0, b->f90), over_metal = film_reflectance(&l, b->base, F(1.0f));
        left = w > 0.0f ? fma(w, 1.0f - v3_max_component(over), (1.0f - w) * left) : left;
        dielectric = v3_select(w > 0.0f, v3_fma(over, w, v3_scale(dielectric, 1.0f - w)), dielectric);
        metal = v3_select(w > 0.0f, v3_fma(over_metal, w, v3_scale(metal, 1.0f - w)), metal);
    }
    if (HAS(TRANSMISSION)) dielectric = v3_scale(dielectric, b->base_first ? b->transmission : F(1.0f));
    *rest = (1.0f - b->metallic) * left;
    return v3_fma(v3_sub(metal, dielectric), b->metallic, dielectric);
}

/* Probabilities that a microfacet seen at this cosine is sampled for reflection and for transmission. The second is not 1 less
 * the first: little passes at grazing angles, and nothing would be left of its digits. */
EC_FN lane_f bsdf_p_reflect(const bsdf *b, v3 reflectance, lane_f rest, lane_f *p_pass)
{
    lane_f reflected = luminance(reflectance), passed = rest * b->transmission * luminance(b->base), sum = reflected + passed;
    *p_pass = sum > 0.0f ? passed / sum : F(0.0f);
    return sum > 0.0f ? reflected / sum : F(1.0f);
}

/* Share of the light that goes to the base which could be scattered there; rest: as bsdf_fresnel has it. */
EC_FN lane_f bsdf_rest_scattered(const bsdf *b, lane_f rest)
{
    return HAS(TRANSMISSION) ? (b->base_first ? 1.0f - b->metallic : rest) : rest;
}

/* Share of the base's light that it scatters back to this side. */
EC_FN lane_f bsdf_scatters_back(const bsdf *b)
{
    lane_f share = 1.0f - b->transmission;
    return HAS(DIFFUSE_TRANSMISSION) ? share * (1.0f - b->diffuse_transmission) : share;
}

/* A film, and a reflectance under its index's own, may lose less than glass does as such: it is given its part of that. */
EC_FN multiscatter bsdf_scatter_again(const bsdf *b, lane_f albedo)
{
    lane_i none = b->facets.smooth; /* stretched lobes lose otherwise, by the azimuth too, and scatter once */
    if (HAS(ANISOTROPY)) none = none | (b->facets.stretch != 1.0f);
    lane_f cosine = min(max(b->wo.z, F(0.0f)), F(1.0f)), metallic = none ? F(0.0f) : b->metallic, glass = F(0.0f);
    if (HAS(TRANSMISSION)) {
        lane_f r = (b->eta - 1.0f) / (b->eta + 1.0f), own = r * r, least = min(b->f0.x, min(b->f0.y, b->f0.z));
        lane_f usual = min(b->f90, (b->refracts & (least < own)) ? max(least, F(0.0f)) / own : F(1.0f));
        if (HAS(IRIDESCENCE)) usual *= 1.0f - b->film.weight;
        glass = none ? F(0.0f) : (1.0f - b->metallic) * b->transmission * usual;
    }
    multiscatter m = multiscatter_make(b->facets.alpha, cosine, b->base, metallic, glass, b->eta, b->refracts);
    multiscatter_weigh(&m, albedo);
    return m;
}

/* multiple: do facets scatter more than once (MULTISCATTER)? */
EC_FN bsdf bsdf_make(const surface *s, v3 wo_local, bool multiple)
{
    bsdf b;
    b.wo = wo_local;
    b.base = s->base;
    b.f0 = s->f0;
    b.f90 = s->f90;
    b.metallic = s->metallic;
    b.facets = ggx_make(s->alpha_ggx, s->smooth, s->stretch);
    b.p_specular = F(0.0f);
    lane_f sum = luminance(b.base);
    b.transmission = HAS(TRANSMISSION) ? s->transmission : F(0.0f);
    b.eta = s->eta;
    b.refracts = HAS(TRANSMISSION) ? s->refracts & (s->transmission > 0.0f) : !TRUE_MASK;
    b.base_first = b.refracts & (b.eta < 1.0f);
    b.diffuse_transmission = HAS(DIFFUSE_TRANSMISSION) ? s->diffuse_transmission : F(0.0f);
    b.transmission_color = s->transmission_color;
    b.p_below = F(0.0f);
    if (HAS(IRIDESCENCE)) b.film = (thin_film){s->film, s->film_ior, s->film_thickness};
    if (HAS(SPECULAR)) {
        lane_f rest;
        lane_f specular = luminance(bsdf_fresnel(&b, min(max(wo_local.z, F(0.0f)), F(1.0f)), &rest));
        lane_f base = luminance(b.base), scattered = base, passed = rest * base;
        if (HAS(DIFFUSE_TRANSMISSION)) {
            lane_f under = b.diffuse_transmission * luminance(b.transmission_color), back = (1.0f - b.diffuse_transmission) * base;
            scattered = under + back;
            b.p_below = under > 0.0f ? (back > 0.0f ? min(max(under / scattered, F(0.1f)), F(0.9f)) : F(1.0f)) : F(0.0f);
        }
        lane_f diffuse = bsdf_rest_scattered(&b, rest) * scattered;
        lane_f most = (1.0f - b.metallic) * (1.0f - min(v3_max_component(b.f0), F(1.0f))) * scattered; /* diffuse, head-on */
        lane_i filmed = HAS(IRIDESCENCE) ? b.film.weight > 0.0f : !TRUE_MASK; /* which may reflect all or nothing at any angle */
        most = (filmed | b.base_first) ? (1.0f - b.metallic) * scattered : most;
        if (HAS(TRANSMISSION)) {
            specular = fma(passed, b.transmission, specular);
            diffuse = diffuse * (1.0f - b.transmission);
            most = most * (1.0f - b.transmission);
        }
        sum = specular + diffuse;
        b.p_specular = sum > 0.0f ? specular / sum : F(0.0f);
        /* A lobe that matters at other angles must not starve. What is left for the base goes by the half vector's angle: there may
         * be some where by wo's own there is none, beyond the critical angle or for rounding. Nothing but a film reflects less than head-on. */
        b.p_specular = (((b.p_specular > 0.0f) | filmed) & (most > 0.0f)) ? min(max(b.p_specular, F(0.1f)), F(0.9f)) : b.p_specular;
        if (HAS(MULTISCATTER)) b.again.p = F(0.0f);
        if (HAS(MULTISCATTER) && multiple) {
            b.again = bsdf_scatter_again(&b, sum);
            sum += b.again.albedo;
        }
    }
#define BSDF_MAKE(feature, layer)                           \
    if (HAS(feature)) {                                     \
        b.layer = layer##_make(&s->layer, wo_local, sum);   \
        sum = fma(b.layer.own, 1.0f - sum, sum);            \
    }
    LAYERS_UP(BSDF_MAKE)
    if (HAS(CLEARCOAT)) b.coat = coat_make(s, wo_local, sum);
    return b;
}

/* What passes, for wi below the surface of a rough one. */
EC_FN v3 bsdf_eval_below(const bsdf *b, v3 wi, lane_f *pdf)
{
    lane_f no = b->wo.z, ni = -wi.z;
    v3 through = v3_make(wi.x, wi.y, ni); /* thin: as if reflected */
    v3 sum = v3_select(b->refracts, v3_fma(wi, b->eta, b->wo), v3_add(b->wo, through));
    lane_f length = sqrt(v3_dot(sum, sum));
    v3 h = v3_scale(sum, copysign(1.0f / length, sum.z));
    lane_f oh = v3_dot(b->wo, h), ih = -v3_dot(wi, h), rest, p_pass;
    lane_i valid = (length > 0.0f) & (oh > 0.0f) & ((ih > 0.0f) | !b->refracts);
    v3 reflectance = bsdf_fresnel(b, min(oh, F(1.0f)), &rest);
    bsdf_p_reflect(b, reflectance, rest, &p_pass);
    lane_f lambda_o = ggx_lambda(&b->facets, b->wo), lambda_i = ggx_lambda(&b->facets, wi), d = ggx_d(&b->facets, h);
    /* Density of wi for that of h: Walter et al. 2007, eq. 17; a mirrored lobe has 1 / (4 oh). */
    lane_f denominator = ih - oh / b->eta;
    lane_f jacobian_oh = b->refracts ? ih * oh / (denominator * denominator) : F(0.25f);
    lane_f f = d * jacobian_oh * 2.0f * ni / fma(ni, lambda_o, no * lambda_i) * rest * b->transmission;
    lane_f density = d * jacobian_oh * 2.0f / (no + lambda_o) * p_pass;
    *pdf = valid ? b->p_specular * density : F(0.0f);
    return v3_select(valid, v3_scale(b->base, f), v3_zero());
}

/* What is scattered through, for wi below the surface; as if it came to the side of wo, by the same layering. */
EC_FN v3 bsdf_eval_diffuse_transmission(const bsdf *b, v3 wi, lane_f *pdf)
{
    v3 sum = v3_add(b->wo, v3_make(wi.x, wi.y, -wi.z));
    lane_f rest, spread = -wi.z * EC_INV_PI;
    bsdf_fresnel(b, min(sqrt(v3_dot(sum, sum)) * 0.5f, F(1.0f)), &rest);
    *pdf = (1.0f - b->p_specular) * b->p_below * spread;
    return v3_scale(b->transmission_color, bsdf_rest_scattered(b, rest) * (1.0f - b->transmission) * b->diffuse_transmission * spread);
}

/* The surface without the layers over it. */
EC_FN v3 bsdf_eval_base(const bsdf *b, v3 wi, lane_f *pdf)
{
    lane_f no = b->wo.z, ni = wi.z;
    lane_i above = (ni > 0.0f) & (no > 0.0f);
    if (!HAS(SPECULAR)) {
        *pdf = above ? ni * EC_INV_PI : F(0.0f);
        return v3_scale(b->base, *pdf);
    }
    v3 sum = v3_add(b->wo, wi);
    lane_f length = sqrt(v3_dot(sum, sum)), oh = min(length * 0.5f, F(1.0f)); /* wo . h, the same for either direction */
    v3 h = v3_scale(sum, 1.0f / length);
    lane_f rest;
    v3 fresnel = bsdf_fresnel(b, oh, &rest);
    lane_f d = ggx_d(&b->facets, h);
    lane_f lambda_o = ggx_lambda(&b->facets, b->wo), lambda_i = ggx_lambda(&b->facets, wi);
    lane_f v_ni = 0.5f * ni / fma(ni, lambda_o, no * lambda_i); /* V cos, which stays finite at grazing angles */
    lane_f diffuse = bsdf_rest_scattered(b, rest) * ni * EC_INV_PI;
    lane_f specular = d * v_ni;
    /* Visible normals: D G1 / (4 no) without the quotient G1 / no (Heitz 2018). */
    lane_f pdf_specular = d * 0.5f / (no + lambda_o);
    if (HAS_PASSING) diffuse *= bsdf_scatters_back(b);
    if (HAS(TRANSMISSION)) {
        lane_f p_pass;
        pdf_specular *= bsdf_p_reflect(b, fresnel, rest, &p_pass);
    }
    if (HAS(SMOOTH)) {
        specular = b->facets.smooth ? F(0.0f) : specular;
        pdf_specular = b->facets.smooth ? F(0.0f) : pdf_specular;
    }
    v3 f = v3_fma(fresnel, specular, v3_scale(b->base, diffuse));
    lane_f p_back = HAS(DIFFUSE_TRANSMISSION) ? (1.0f - b->p_specular) * (1.0f - b->p_below) : 1.0f - b->p_specular;
    *pdf = above ? fma(b->p_specular, pdf_specular, p_back * ni * EC_INV_PI) : F(0.0f);
    f = v3_select(above, f, v3_zero());
    if (HAS(TRANSMISSION)) {
        lane_i below = (ni < 0.0f) & (no > 0.0f) & (b->transmission > 0.0f) & !b->facets.smooth;
        if (any_lane(below)) {
            lane_f pdf_below;
            v3 f_below = bsdf_eval_below(b, wi, &pdf_below);
            f = v3_select(below, f_below, f);
            *pdf = below ? pdf_below : *pdf;
        }
    }
    if (HAS(DIFFUSE_TRANSMISSION)) {
        lane_i below = (ni < 0.0f) & (no > 0.0f) & (b->diffuse_transmission > 0.0f);
        if (any_lane(below)) {
            lane_f pdf_below;
            v3 f_below = bsdf_eval_diffuse_transmission(b, wi, &pdf_below);
            f = v3_select(below, v3_add(f, f_below), f);
            *pdf = below ? *pdf + pdf_below : *pdf;
        }
    }
    return f;
}

/* f |cos(wi)| and its sampling density. Both leave out the single directions of smooth surfaces. */
EC_FN v3 bsdf_eval(const bsdf *b, v3 wi, lane_f *pdf)
{
    v3 f = bsdf_eval_base(b, wi, pdf);
    if (HAS(MULTISCATTER) && HAS(SPECULAR)) multiscatter_over(&b->again, b->wo, wi, &f, pdf);
#define BSDF_OVER(feature, layer) \
    if (HAS(feature)) layer##_over(&b->layer, b->wo, wi, &f, pdf);
    LAYERS_UP(BSDF_OVER)
    if (HAS(CLEARCOAT)) coat_over(&b->coat, wi, &f, pdf);
    return f;
}

/* Does it send light in single directions only? */
EC_FN lane_i bsdf_is_single(const bsdf *b)
{
    lane_i single = b->facets.smooth & (b->p_specular == 1.0f);
#define BSDF_SPREADS(feature, layer) \
    if (HAS(feature)) single = single & (b->layer.p == 0.0f);
    LAYERS_UP(BSDF_SPREADS)
    if (HAS(CLEARCOAT)) single = single & ((b->coat.p == 0.0f) | b->coat.facets.smooth);
    return single;
}

typedef struct bsdf_direction {
    v3 wi;
    v3 weight;  /* f |cos wi| / pdf */
    lane_f pdf; /* 0: no direction; < 0: the only one of its kind, which no other strategy finds */
} bsdf_direction;

/* The mirrored or the passing direction at a sampled microfacet; u in [0, 1] chooses. The weight is a smooth surface's. */
EC_FN bsdf_direction bsdf_sample_specular(const bsdf *b, lane_f cosine, lane_f sine, lane_f u2, lane_f u)
{
    bsdf_direction r;
    v3 m = ggx_sample(&b->facets, b->wo, cosine, sine, u2);
    lane_f om = v3_dot(b->wo, m);
    r.wi = v3_fma(m, 2.0f * om, v3_negate(b->wo));
    if (HAS(DIFFUSE_TRANSMISSION)) r.wi.z = max(r.wi.z, F(0.0f)); /* mirrored onto the other side: not what is transmitted diffusely */
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
        /* Off a tilted microfacet onto the wrong side: no direction, nor in the densities. */
        r.wi.z = (passes ? r.wi.z < 0.0f : r.wi.z > 0.0f) ? r.wi.z : F(0.0f);
    }
    return r;
}

/* What knows nothing of the material: uniform over the hemisphere about ns, or the sphere where light passes. */
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

/* Probability that no single direction is sampled. */
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

/* A direction from (u1, u2), where u2 chooses the lobe and goes on; u_pass: does it pass, where that is for the facet to say? blind: uniform,
 * but for what a smooth surface mirrors or lets pass. */
EC_FN bsdf_direction bsdf_sample(const bsdf *b, bool blind, lane_f u1, chooser number, lane_f u_pass)
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
    if (may_again) { /* of smooth surfaces its p is 0 */
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
    v3 f = bsdf_eval(b, r.wi, &r.pdf);
    if (blind) r.pdf = blind_pdf * bsdf_p_spread(b);
    r.weight = v3_scale(f, 1.0f / r.pdf);
    if (HAS(SMOOTH)) {
        r.weight = v3_select(single, single_weight, r.weight);
        r.pdf = single ? F(-1.0f) : r.pdf;
    }
    return r;
}

#endif
