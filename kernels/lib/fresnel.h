/* Fresnel reflectance of an interface. */
#ifndef EC_LIB_FRESNEL_H
#define EC_LIB_FRESNEL_H

#include "math.h"

EC_FN lane_f pow5(lane_f x)
{
    lane_f x2 = x * x;
    return x2 * x2 * x;
}

/* Returns (eta cos_t)^2 = cos^2 + eta^2 - 1 (Snell), which is not above 0 beyond the critical angle. Adds what the square and the difference round
 * off (Dekker 1971): near the critical angle nothing else is left. */
EC_FN lane_f refracted_cosine2(lane_f cosine, lane_f eta)
{
    lane_f square = eta * eta, less = square - 1.0f;
    lane_f lost = fma(eta, eta, -square) + (square - (less + 1.0f));
    return fma(cosine, cosine, less) + lost;
}

/* Returns the unpolarised reflectance between two dielectrics (Fresnel 1823), for the cosine c of incidence and the index beyond over the
 * index here; exactly 1 beyond the critical angle, exactly 0 where the index stays the same. With g of Snell's law above, c - g
 * and eta^2 c - g cancel between media that are nearly alike, so eta^2 - 1 is taken out of both:
 * c - g = -(eta^2 - 1) / (c + g), and eta^2 c - g = (eta^2 - 1) c + (c - g). */
EC_FN lane_f fresnel_dielectric(lane_f cosine, lane_f eta)
{
    lane_f g2 = refracted_cosine2(cosine, eta), g = sqrt(max(g2, F(0.0f))), sum = cosine + g;
    lane_f less = (eta - 1.0f) * (eta + 1.0f), inverse = 1.0f / sum, q = less * inverse;
    lane_f parallel = q * fma(cosine, sum, F(-1.0f)) / fma(eta * eta, cosine, g), perpendicular = q * inverse;
    lane_f f = min(0.5f * fma(parallel, parallel, perpendicular * perpendicular), F(1.0f));
    return ((g2 > 0.0f) & (cosine > 0.0f)) ? f : F(1.0f);
}

/* Returns where the reflectance lies between its values head-on (0) and at grazing angles (1): Schlick's (1-c)^5 in general, as glTF asks; exact
 * where light is refracted, so that total reflection sets in where refraction ends. (Above an index of 2 + sqrt(3) the exact one dips under its
 * value head-on before it rises; here it stays there.) */
EC_FN lane_f fresnel_rise(lane_f cosine, lane_f eta, lane_i refracts)
{
    lane_f rise = pow5(1.0f - cosine);
    if (!any_lane(refracts)) return rise;
    lane_f r = (eta - 1.0f) / (eta + 1.0f), head_on = r * r;
    lane_f exact = max((fresnel_dielectric(cosine, eta) - head_on) / (1.0f - head_on), F(0.0f));
    return refracts ? exact : rise;
}

/* Refracts w, a unit vector away from the surface, about the unit normal m on its side (Snell's law). Valid only below the critical angle. */
EC_FN v3 refract(v3 w, v3 m, lane_f eta)
{
    lane_f cosine = v3_dot(w, m), g = sqrt(max(refracted_cosine2(cosine, eta), F(0.0f)));
    return v3_scale(v3_sub(v3_scale(m, cosine - g), w), 1.0f / eta);
}

#endif
