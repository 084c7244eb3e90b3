/* Light from infinity: constant, or an equirectangular map with bilinear look-up. Row 0 is +y; u = 0.5 + atan2(z, x) / 2pi. */
#ifndef EC_LIB_ENVIRONMENT_H
#define EC_LIB_ENVIRONMENT_H

#include "../shared/params.h"
#include "../shared/scene_buffers.h"
#include "distribution.h"
#include "sampler.h"

typedef struct environment {
    constant ec_params *params;
    global const float *texels; /* R, G, B, pmf of the texel */
    global const uint *table;   /* ec_distribution_entry by word: of rows, then of each row's texels */
} environment;

/* The map may stand turned: directions of the scene in its own frame, and back. */
EC_FN v3 environment_to_map(const environment *e, v3 d)
{
    constant float *r = e->params->environment_turn;
    if (!HAS(ENVIRONMENT_TURN) || !e->params->environment_turned) return d;
    return v3_make(fma(d.x, F(r[0]), fma(d.y, F(r[4]), d.z * r[8])), fma(d.x, F(r[1]), fma(d.y, F(r[5]), d.z * r[9])),
                   fma(d.x, F(r[2]), fma(d.y, F(r[6]), d.z * r[10])));
}
EC_FN v3 environment_from_map(const environment *e, v3 d)
{
    constant float *r = e->params->environment_turn;
    if (!HAS(ENVIRONMENT_TURN) || !e->params->environment_turned) return d;
    return v3_make(fma(d.x, F(r[0]), fma(d.y, F(r[1]), d.z * r[2])), fma(d.x, F(r[4]), fma(d.y, F(r[5]), d.z * r[6])),
                   fma(d.x, F(r[8]), fma(d.y, F(r[9]), d.z * r[10])));
}

/* v by both sides of the angle: acos(y) would have lost half the digits at the poles. */
EC_FN void environment_uv(v3 d, lane_f *u, lane_f *v)
{
    *u = 0.5f + atan2_over_2pi(d.z, d.x);
    *v = 2.0f * fabs(atan2_over_2pi(sqrt(fma(d.x, d.x, d.z * d.z)), d.y));
}

EC_FN v3 environment_texel(const environment *e, lane_u at)
{
    quad q = gather_quad(e->texels, at * 4u);
    return v3_make(q.a, q.b, q.c);
}

/* Density, per solid angle, with which the light sampling picks direction d at (u, v), the choice of this light included. */
EC_FN lane_f environment_pdf_at(const environment *e, lane_u texel, lane_f sin_theta)
{
    float texels = (float)e->params->environment_width * (float)e->params->environment_height;
    return gather_f(e->texels, texel * 4u + 3u) * (e->params->environment_pmf * texels / (2.0f * EC_PI * EC_PI)) /
           max(sin_theta, F(1e-7f));
}

EC_FN v3 environment_bilinear(const environment *e, lane_f u, lane_f v)
{
    int width = (int)e->params->environment_width, height = (int)e->params->environment_height;
    lane_f x = fma(u, F((float)width), F(-0.5f)), y = fma(v, F((float)height), F(-0.5f));
    lane_f xb = floor(x), yb = floor(y), fx = x - xb, fy = y - yb;
    lane_i x0 = to_lane_i(xb), x1 = x0 + 1, y0 = max(to_lane_i(yb), I(0)), y1 = min(to_lane_i(yb) + 1, I(height - 1));
    y0 = min(y0, I(height - 1));
    x0 = min(x0 < 0 ? I(width - 1) : x0, I(width - 1)); /* the seam wraps */
    x1 = x1 >= width ? I(0) : x1;
    lane_f gx = 1.0f - fx, gy = 1.0f - fy;
    v3 r = v3_scale(environment_texel(e, int_to_lane_u(y0 * width + x0)), gx * gy);
    r = v3_fma(environment_texel(e, int_to_lane_u(y0 * width + x1)), fx * gy, r);
    r = v3_fma(environment_texel(e, int_to_lane_u(y1 * width + x0)), gx * fy, r);
    return v3_fma(environment_texel(e, int_to_lane_u(y1 * width + x1)), fx * fy, r);
}

/* Radiance from direction d (unit) and the light sampling's density for it. */
EC_FN v3 environment_look_up(const environment *e, v3 d, lane_f *pdf)
{
    constant float *constant_radiance = e->params->environment;
    v3 factor = v3_make(F(constant_radiance[0]), F(constant_radiance[1]), F(constant_radiance[2]));
    if (!HAS(ENVIRONMENT_MAP) || !e->texels) {
        *pdf = F(e->params->environment_pmf * 0.25f * EC_INV_PI);
        return factor;
    }
    lane_f u, v;
    d = environment_to_map(e, d);
    environment_uv(d, &u, &v);
    int width = (int)e->params->environment_width, height = (int)e->params->environment_height;
    lane_i x = min(to_lane_i(u * (float)width), I(width - 1)), y = min(to_lane_i(v * (float)height), I(height - 1));
    *pdf = environment_pdf_at(e, int_to_lane_u(y * width + x), sqrt(fma(d.x, d.x, d.z * d.z)));
    return v3_mul(environment_bilinear(e, u, v), factor);
}

/* A direction by importance: a row by r2, its texel by r1, then by what is left of them uniform in (u, v) inside it. */
EC_FN v3 environment_sample(const environment *e, lane_u r1, lane_u r2, lane_f *pdf, v3 *radiance)
{
    constant float *constant_radiance = e->params->environment;
    v3 factor = v3_make(F(constant_radiance[0]), F(constant_radiance[1]), F(constant_radiance[2]));
    lane_f cosine;
    if (!HAS(ENVIRONMENT_MAP) || !e->texels) {
        lane_f u1 = to_unit(r1), u2 = to_unit(r2);
        lane_f z = fma(u2, F(-2.0f), F(1.0f)), s = 2.0f * sqrt(u2 * (1.0f - u2)); /* not of 1 - z^2, which cancels at the poles */
        lane_f sine = sincos_2pi(u1, &cosine);
        *pdf = F(e->params->environment_pmf * 0.25f * EC_INV_PI);
        *radiance = factor;
        return v3_make(s * cosine, z, s * sine);
    }
    uint width = e->params->environment_width, height = e->params->environment_height;
    lane_f in_x, in_y;
    lane_u y = distribution_sample(e->table, U(0), height, r2, &in_y);
    lane_u x = distribution_sample(e->table, y * width + height, width, r1, &in_x), texel = y * width + x;
    lane_f u = (to_lane_f(x) + in_x) / (float)width, v = (to_lane_f(y) + in_y) / (float)height;
    lane_f cos_theta, sin_theta = sincos_2pi(v * 0.5f, &cos_theta);
    lane_f sin_phi = sincos_2pi(u, &cosine); /* u = 0.5 + phi / 2pi: both signs turn */
    sin_theta = fabs(sin_theta);
    *pdf = environment_pdf_at(e, texel, sin_theta);
    *radiance = v3_mul(environment_bilinear(e, u, v), factor);
    return environment_from_map(e, v3_make(-sin_theta * cosine, cos_theta, -sin_theta * sin_phi));
}

#endif
