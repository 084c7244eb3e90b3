/* Lights as points at their centres, as before there was sampling (host/pack/light_centres.c): a lamp shines from its centroid with all
 * its area, the environment with its mean from everywhere. */
#ifndef EC_LIB_LIGHT_CENTRE_H
#define EC_LIB_LIGHT_CENTRE_H

#include "light.h"

/* Makes the sample of light `id`, the same for every lane, by its centre. radiance: irradiance of a plane at p that faces it. Not valid for the
 * environment. */
EC_FN light_sample light_from_centre(global const float *table, uint id, const geometry *g, lane_i m, v3 p, float scene_radius)
{
    light_record l = light_load_one(table, id);
    lane_u type = l.kind & EC_LIGHT_KIND_MASK;
    light_sample s;
    s.valid = !TRUE_MASK;
    s.wi = v3_make(F(0.0f), F(0.0f), F(1.0f));
    s.radiance = v3_zero();
    if (HAS(AREA_LIGHTS)) {
        /* The density per solid angle is pmf d^2 / (area cos). */
        lane_f third = F(1.0f / 3.0f);
        lane_i is = m & (type == EC_KIND_TRIANGLE);
        s = light_point_of_triangle(&l, is, p, third, third);
        s.radiance = v3_scale(light_radiance(&l, g, is, third, third, s.wi), l.pmf / s.pdf);
    }
    if (HAS(PUNCTUAL_LIGHTS) || HAS(AREA_LIGHTS)) { /* curved lamps count as points */
        lane_i is = (type >= EC_KIND_POINT) & (type <= EC_KIND_DIRECTIONAL);
        light_sample other = light_sample_punctual(&l, m & is, p, scene_radius);
        /* A body's surface must not shadow its own centre. */
        lane_f way = sqrt(v3_dot(other.towards, other.towards)), outside = max(way - l.pdf_a, F(0.0f));
        other.towards = v3_scale(other.towards, l.pdf_a > 0.0f ? outside / way : F(1.0f));
        s = HAS(AREA_LIGHTS) ? light_sample_select(is, other, s) : other;
    }
    return s;
}

/* Returns what a surface of this albedo reflects of the environment's mean. */
EC_FN v3 light_ambient(constant ec_params *params, v3 albedo)
{
    constant float *mean = params->environment_mean;
    return v3_mul(albedo, v3_make(F(mean[0]), F(mean[1]), F(mean[2])));
}

#endif
