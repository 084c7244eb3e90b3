/* The lobes of the BSDF (bsdf.h) at a surface for wo: reflectances, and the probability of sampling each. */
#ifndef EC_LIB_BSDF_LOBES_H
#define EC_LIB_BSDF_LOBES_H

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
    lane_f p_specular;   /* probability of sampling the specular lobe (reflection, transmission), not the diffuse one */
    lane_f transmission, eta;
    lane_i refracts;
    lane_i base_first;   /* light reaches the base before the face that reflects: from inside a body */
    lane_f diffuse_transmission;        /* share of diffusely scattered light that comes out on the other side */
    v3 transmission_color;           /* its colour */
    lane_f p_below;      /* probability that the diffuse lobe samples the other side */
    thin_film film;
    multiscatter again;  /* light that facets scatter more than once */
#define BSDF_LAYER(feature, layer) layer layer;
    LAYERS_UP(BSDF_LAYER)
    coat coat;
} bsdf;

/* Returns the reflectance of a microfacet, for the cosine between its normal and wo. *rest: the share of light that goes on to the base, to be
 * scattered diffusely or to pass. */
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

/* Returns the probability that a microfacet is sampled for reflection; *p_pass: for transmission. *p_pass is not computed as 1 minus the other:
 * little passes at grazing angles, and nothing would be left of its digits. */
EC_FN lane_f bsdf_p_reflect(const bsdf *b, v3 reflectance, lane_f rest, lane_f *p_pass)
{
    lane_f reflected = luminance(reflectance), passed = rest * b->transmission * luminance(b->base), sum = reflected + passed;
    *p_pass = sum > 0.0f ? passed / sum : F(0.0f);
    return sum > 0.0f ? reflected / sum : F(1.0f);
}

/* Returns the share of light that reaches the base and may be scattered there; rest: from bsdf_fresnel. */
EC_FN lane_f bsdf_rest_scattered(const bsdf *b, lane_f rest)
{
    return HAS(TRANSMISSION) ? (b->base_first ? 1.0f - b->metallic : rest) : rest;
}

/* Returns the share of the light at the base that is scattered back to wo's side. */
EC_FN lane_f bsdf_scatters_back(const bsdf *b)
{
    lane_f share = 1.0f - b->transmission;
    return HAS(DIFFUSE_TRANSMISSION) ? share * (1.0f - b->diffuse_transmission) : share;
}

/* Makes the lobe of multiple scattering; albedo: about what single scattering reflects. Glass with a film, or with a reflectance below that of its
 * index, may lose less than plain glass does, and is given a smaller share in proportion. */
EC_FN multiscatter bsdf_scatter_again(const bsdf *b, lane_f albedo)
{
    lane_i none = b->facets.smooth; /* stretched lobes lose differently, and by azimuth too: they scatter once */
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

/* multiple: adds light that facets scatter more than once (MULTISCATTER). */
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
        lane_f most = (1.0f - b.metallic) * (1.0f - min(v3_max_component(b.f0), F(1.0f))) * scattered; /* of the diffuse lobe, head-on */
        lane_i filmed = HAS(IRIDESCENCE) ? b.film.weight > 0.0f : !TRUE_MASK; /* a film may reflect all or nothing at any angle */
        most = (filmed | b.base_first) ? (1.0f - b.metallic) * scattered : most;
        if (HAS(TRANSMISSION)) {
            specular = fma(passed, b.transmission, specular);
            diffuse = diffuse * (1.0f - b.transmission);
            most = most * (1.0f - b.transmission);
        }
        sum = specular + diffuse;
        b.p_specular = sum > 0.0f ? specular / sum : F(0.0f);
        /* Keeps both lobes sampled, since each may matter at other angles. Values take Fresnel at the half vector, so the base may get light where
         * none is left at wo's own angle, beyond the critical angle or by rounding. Only a film reflects less than head-on. */
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

#endif
