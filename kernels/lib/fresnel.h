/* How much an interface reflects. */
#ifndef EC_LIB_FRESNEL_H
#define EC_LIB_FRESNEL_H

#include "math.h"

EC_FN lane_f pow5(lane_f x)
{
    lane_f x2 = x * x;
    return x2 * x2 * x;
}

/* Unpolarised reflectance between two dielectrics (Fresnel 1823), for the cosine of incidence and the index beyond over the
 * index here; exactly 1 beyond the critical angle. */
EC_FN lane_f fresnel_dielectric(lane_f cosine, lane_f eta)
{
    lane_f cos2_t = 1.0f - fma(-cosine, cosine, F(1.0f)) / (eta * eta);
    lane_f cos_t = sqrt(max(cos2_t, F(0.0f)));
    lane_f parallel = fma(eta, cosine, -cos_t) / fma(eta, cosine, cos_t);
    lane_f perpendicular = fma(-eta, cos_t, cosine) / fma(eta, cos_t, cosine);
    lane_f f = 0.5f * fma(parallel, parallel, perpendicular * perpendicular);
    return ((cos2_t > 0.0f) & (cosine > 0.0f)) ? f : F(1.0f);
}

/* Where between its values head-on and at grazing angles is the reflectance? Schlick's (1-c)^5 between unlike media in
 * general, as glTF asks; exact where light is refracted, so that total reflection sets in where refraction ends. */
EC_FN lane_f fresnel_rise(lane_f cosine, lane_f eta, lane_i refracts)
{
    lane_f rise = pow5(1.0f - cosine);
    if (!any_lane(refracts)) return rise;
    lane_f r = (eta - 1.0f) / (eta + 1.0f), head_on = r * r;
    lane_f exact = max((fresnel_dielectric(cosine, eta) - head_on) / (1.0f - head_on), F(0.0f));
    return refracts ? exact : rise;
}

/* Direction of w, a unit vector away from the surface, refracted about the unit normal m on its side (Snell's law). Call it
 * only under the critical angle. */
EC_FN v3 refract(v3 w, v3 m, lane_f eta)
{
    lane_f cosine = v3_dot(w, m), inverse = 1.0f / eta;
    lane_f cos_t = sqrt(max(1.0f - fma(-cosine, cosine, F(1.0f)) * inverse * inverse, F(0.0f)));
    return v3_fma(w, -inverse, v3_scale(m, fma(cosine, inverse, -cos_t)));
}

#endif
