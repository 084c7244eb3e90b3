/* Whitted's surfaces (Whitted 1980), their coefficients taken from a glTF material:
 *
 *   mirror     F where roughness is under 0.1, else 0: followed by a reflected ray
 *   pass       rest transmission base, at any roughness: followed by a refracted ray
 *   diffuse    rest (1 - transmission) base / pi
 *   highlight  where nothing is mirrored: F (n + 8) / (8 pi) (ns . h)^n, n = 2 / alpha^2 - 2
 *
 * F and rest are those of bsdf_fresnel, at ns for rays and at the half vector for light. Blinn 1977, normalised as by
 * Akenine-Moeller et al. 2008, eq. 7.47; n has a Blinn lobe as wide as GGX's (Walter et al. 2007). */
#ifndef EC_LIB_BLINN_PHONG_H
#define EC_LIB_BLINN_PHONG_H

#include "bsdf.h"

#define EC_MIRROR_ALPHA 0.01f /* roughness 0.1 */

EC_FN lane_i whitted_mirrors(const surface *s)
{
    return HAS(SPECULAR) ? (s->alpha_ggx < EC_MIRROR_ALPHA) : !TRUE_MASK;
}

/* f cos(wi) for wi in local directions. */
EC_FN v3 blinn_phong_eval(const bsdf *b, lane_i mirrors, v3 wi)
{
    lane_i above = (wi.z > 0.0f) & (b->wo.z > 0.0f);
    if (!HAS(SPECULAR)) return v3_select(above, v3_scale(b->base, wi.z * EC_INV_PI), v3_zero());
    v3 sum = v3_add(b->wo, wi);
    lane_f length = sqrt(v3_dot(sum, sum)), rest;
    v3 h = v3_scale(sum, 1.0f / length);
    v3 fresnel = bsdf_fresnel(b, min(length * 0.5f, F(1.0f)), &rest);
    lane_f n = 2.0f / (HAS(ANISOTROPY) ? b->facets.alpha2 * b->facets.stretch : b->facets.alpha2) - 2.0f;
    /* The logarithm takes the sine too, which keeps the digits of narrow lobes. */
    lane_f log_cosine = 0.5f * log_unit(h.z * h.z, fma(h.x, h.x, h.y * h.y));
    lane_f lobe = (n + 8.0f) * (0.125f * EC_INV_PI) * exp_negative(n * log_cosine);
    lane_f diffuse = bsdf_rest_scattered(b, rest) * bsdf_scatters_back(b) * EC_INV_PI;
    v3 f = v3_fma(fresnel, mirrors ? F(0.0f) : lobe, v3_scale(b->base, diffuse));
    return v3_select(above, v3_scale(f, wi.z), v3_zero());
}

/* Returns the reflectance for light that is the same from all directions. Rays follow what is mirrored or passes, which is left out. */
EC_FN v3 blinn_phong_albedo(const bsdf *b, lane_i mirrors)
{
    if (!HAS(SPECULAR)) return b->base;
    lane_f rest;
    v3 fresnel = bsdf_fresnel(b, F(1.0f), &rest);
    return v3_fma(b->base, bsdf_rest_scattered(b, rest) * bsdf_scatters_back(b), v3_select(mirrors, v3_zero(), fresnel));
}

#endif
