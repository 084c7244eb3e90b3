/* The metallic-roughness BRDF of glTF 2.0, appendix B, with KHR_materials_specular:
 *
 *   f = metallic F_m D V + (1 - metallic) (F_d D V + (1 - max F_d) base / pi)
 *
 * D, V: GGX with height-correlated Smith masking (Heitz 2014, eq. 99); F: Schlick. Directions are local (z = ns) and point
 * away from the surface. Values include the cosine of wi; pdfs are per solid angle. */
#ifndef EC_LIB_BSDF_H
#define EC_LIB_BSDF_H

#include "surface.h"

typedef struct bsdf {
    v3 wo;
    v3 base, f0;
    lane_f f90, metallic, alpha2, alpha;
    lane_f p_specular; /* probability of sampling the GGX lobe */
} bsdf;

EC_FN lane_f pow5(lane_f x)
{
    lane_f x2 = x * x;
    return x2 * x2 * x;
}

/* Specular reflectance F and the share left to the diffuse lobe, for the cosine between half vector and either direction. */
EC_FN v3 bsdf_fresnel(const bsdf *b, lane_f cosine, lane_f *diffuse)
{
    lane_f w = pow5(1.0f - cosine);
    v3 dielectric = v3_make(fma(b->f90 - b->f0.x, w, b->f0.x), fma(b->f90 - b->f0.y, w, b->f0.y),
                            fma(b->f90 - b->f0.z, w, b->f0.z));
    v3 metal = v3_make(fma(1.0f - b->base.x, w, b->base.x), fma(1.0f - b->base.y, w, b->base.y),
                       fma(1.0f - b->base.z, w, b->base.z));
    *diffuse = (1.0f - b->metallic) * (1.0f - min(v3_max_component(dielectric), F(1.0f)));
    return v3_fma(v3_sub(metal, dielectric), b->metallic, dielectric);
}

EC_FN bsdf bsdf_make(const surface *s, v3 wo_local)
{
    bsdf b;
    b.wo = wo_local;
    b.base = s->base;
    b.f0 = s->f0;
    b.f90 = s->f90;
    b.metallic = s->metallic;
    b.alpha = s->alpha_ggx;
    b.alpha2 = s->alpha_ggx * s->alpha_ggx;
    b.p_specular = F(0.0f);
    if (HAS(SPECULAR)) {
        lane_f diffuse;
        lane_f specular = luminance(bsdf_fresnel(&b, min(max(wo_local.z, F(0.0f)), F(1.0f)), &diffuse));
        diffuse *= luminance(b.base);
        lane_f sum = specular + diffuse;
        b.p_specular = sum > 0.0f ? specular / sum : F(0.0f);
        /* A lobe that matters at other angles must not starve. */
        b.p_specular = ((b.p_specular > 0.0f) & (diffuse > 0.0f)) ? min(max(b.p_specular, F(0.1f)), F(0.9f)) : b.p_specular;
    }
    return b;
}

/* f cos(wi) and its sampling density; both 0 where wi is below the surface. */
EC_FN v3 bsdf_eval(const bsdf *b, v3 wi, lane_f *pdf)
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
    lane_f diffuse_share;
    v3 fresnel = bsdf_fresnel(b, oh, &diffuse_share);
    /* D from components: 1 - cos^2 would lose every digit of a narrow lobe. */
    lane_f k = fma(fma(h.x, h.x, h.y * h.y), 1.0f / b->alpha2, h.z * h.z);
    lane_f d = EC_INV_PI / (b->alpha2 * k * k);
    lane_f lambda_o = sqrt(fma(no * no, 1.0f - b->alpha2, b->alpha2));
    lane_f lambda_i = sqrt(fma(ni * ni, 1.0f - b->alpha2, b->alpha2));
    lane_f v_ni = 0.5f * ni / fma(ni, lambda_o, no * lambda_i); /* V cos, which stays finite at grazing angles */
    lane_f diffuse = diffuse_share * ni * EC_INV_PI;
    lane_f specular = d * v_ni;
    v3 f = v3_fma(fresnel, specular, v3_scale(b->base, diffuse));
    /* Visible normals: D G1 / (4 no) without the quotient G1 / no (Heitz 2018). */
    lane_f pdf_specular = d * 0.5f / (no + lambda_o);
    *pdf = above ? fma(b->p_specular, pdf_specular, (1.0f - b->p_specular) * ni * EC_INV_PI) : F(0.0f);
    return v3_select(above, f, v3_zero());
}

/* What knows nothing of the material: uniform over the hemisphere, of density EC_HEMISPHERE_PDF. */
#define EC_HEMISPHERE_PDF (0.5f * EC_INV_PI)
EC_FN v3 hemisphere_sample(lane_f u1, lane_f u2)
{
    lane_f cosine, sine = sincos_2pi(u1, &cosine), r = sqrt(max(fma(-u2, u2, F(1.0f)), F(0.0f)));
    return v3_make(r * cosine, r * sine, u2);
}

/* A direction from (u1, u2); choice picks the lobe. GGX: visible normals by spherical caps (Dupuy, Benyoub 2023). */
EC_FN v3 bsdf_sample(const bsdf *b, lane_f u1, lane_f u2, lane_f choice)
{
    lane_f cosine, sine = sincos_2pi(u1, &cosine);
    lane_f r = sqrt(u2);
    v3 wi = v3_make(r * cosine, r * sine, sqrt(max(1.0f - u2, F(0.0f))));
    if (!HAS(SPECULAR)) return wi;
    lane_i specular = choice < b->p_specular;
    if (!any_lane(specular)) return wi;
    v3 warped = v3_normalize(v3_make(b->wo.x * b->alpha, b->wo.y * b->alpha, b->wo.z));
    lane_f z = fma(1.0f - u2, 1.0f + warped.z, -warped.z);
    lane_f sin_theta = sqrt(min(max(1.0f - z * z, F(0.0f)), F(1.0f)));
    v3 c = v3_add(v3_make(sin_theta * cosine, sin_theta * sine, z), warped);
    v3 m = v3_normalize(v3_make(c.x * b->alpha, c.y * b->alpha, c.z));
    v3 reflected = v3_fma(m, 2.0f * v3_dot(b->wo, m), v3_negate(b->wo));
    return v3_select(specular, reflected, wi);
}

#endif
