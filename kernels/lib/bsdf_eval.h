/* Values and sampling densities of the BSDF (bsdf.h). */
#ifndef EC_LIB_BSDF_EVAL_H
#define EC_LIB_BSDF_EVAL_H

#include "bsdf_lobes.h"

/* Evaluates the transmission of a rough surface, for wi below it. */
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

/* Evaluates diffuse transmission, for wi below the surface, with the same layering as for light that comes out on wo's side. */
EC_FN v3 bsdf_eval_diffuse_transmission(const bsdf *b, v3 wi, lane_f *pdf)
{
    v3 sum = v3_add(b->wo, v3_make(wi.x, wi.y, -wi.z));
    lane_f rest, spread = -wi.z * EC_INV_PI;
    bsdf_fresnel(b, min(sqrt(v3_dot(sum, sum)) * 0.5f, F(1.0f)), &rest);
    *pdf = (1.0f - b->p_specular) * b->p_below * spread;
    return v3_scale(b->transmission_color, bsdf_rest_scattered(b, rest) * (1.0f - b->transmission) * b->diffuse_transmission * spread);
}

/* Evaluates the surface without the layers over it. */
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

/* Returns what passes a smooth surface in its single direction, whose component along ns is wi_z, for light along wo. */
EC_FN v3 bsdf_passing(const bsdf *b, lane_f wi_z)
{
    lane_f rest;
    bsdf_fresnel(b, min(max(b->wo.z, F(0.0f)), F(1.0f)), &rest);
#define PASSING_LEAVES(feature, layer) \
    if (HAS(feature)) rest *= layer##_leaves(&b->layer, wi_z);
    LAYERS_UP(PASSING_LEAVES)
    if (HAS(CLEARCOAT)) rest *= 1.0f - b->coat.share;
    return v3_scale(b->base, rest * b->transmission);
}

/* Returns the lanes whose BSDF has single directions only. */
EC_FN lane_i bsdf_is_single(const bsdf *b)
{
    lane_i single = b->facets.smooth & (b->p_specular == 1.0f);
#define BSDF_SPREADS(feature, layer) \
    if (HAS(feature)) single = single & (b->layer.p == 0.0f);
    LAYERS_UP(BSDF_SPREADS)
    if (HAS(CLEARCOAT)) single = single & ((b->coat.p == 0.0f) | b->coat.facets.smooth);
    return single;
}

#endif
