/* Microfacets with GGX's distribution of normals and height-correlated Smith masking (Walter et al. 2007; Heitz 2014, eq. 99).
 * Directions are local, z along the surface's normal. */
#ifndef EC_LIB_GGX_H
#define EC_LIB_GGX_H

#include "../shared/features.h"
#include "math.h"

typedef struct ggx {
    lane_f alpha, alpha2;
    lane_i smooth;  /* all facets' normals are the surface's */
    lane_f stretch; /* of the lobe along x: alpha there is alpha stretch (ANISOTROPY); 1 else */
} ggx;

EC_FN ggx ggx_make(lane_f alpha, lane_i smooth, lane_f stretch)
{
    ggx g = {alpha, alpha * alpha, HAS(SMOOTH) ? smooth : !TRUE_MASK, HAS(ANISOTROPY) ? stretch : F(1.0f)};
    return g;
}

/* Density of microfacet normals, from components: 1 - cos^2 would lose every digit of a narrow lobe. */
EC_FN lane_f ggx_d(const ggx *g, v3 h)
{
    lane_f x = HAS(ANISOTROPY) ? h.x / g->stretch : h.x;
    lane_f k = fma(fma(x, x, h.y * h.y), 1.0f / g->alpha2, h.z * h.z);
    lane_f d = EC_INV_PI / (g->alpha2 * k * k);
    return HAS(ANISOTROPY) ? d / g->stretch : d;
}

/* cos sqrt(1 + alpha^2 tan^2): Smith's masking in a form that stays finite at grazing angles. */
EC_FN lane_f ggx_lambda(const ggx *g, v3 w)
{
    lane_f square = fma(w.z * w.z, 1.0f - g->alpha2, g->alpha2);
    if (HAS(ANISOTROPY)) {
        lane_f x = w.x * g->stretch;
        square = g->stretch == 1.0f ? square : fma(g->alpha2, fma(x, x, w.y * w.y), w.z * w.z);
    }
    return sqrt(square);
}

/* Samples a visible normal by spherical caps (Dupuy, Benyoub 2023) from an angle, given by cosine and sine, and u2. Smooth surfaces have only one. */
EC_FN v3 ggx_sample(const ggx *g, v3 wo, lane_f cosine, lane_f sine, lane_f u2)
{
    lane_f alpha_x = HAS(ANISOTROPY) ? g->alpha * g->stretch : g->alpha;
    v3 warped = v3_normalize(v3_make(wo.x * alpha_x, wo.y * g->alpha, wo.z));
    /* z of the point on the cap is 1 - down, but 1 - z^2 and z + warped.z would cancel at its ends. */
    lane_f height = 1.0f + warped.z, down = u2 * height, sin_theta = sqrt(max(down * (2.0f - down), F(0.0f)));
    v3 c = v3_make(fma(sin_theta, cosine, warped.x), fma(sin_theta, sine, warped.y), (1.0f - u2) * height);
    v3 m = v3_normalize(v3_make(c.x * alpha_x, c.y * g->alpha, c.z));
    return HAS(SMOOTH) ? v3_select(g->smooth, v3_make(F(0.0f), F(0.0f), F(1.0f)), m) : m;
}

#endif
