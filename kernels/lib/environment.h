/* Light from infinity: constant, or an equirectangular map with bilinear look-up. Row 0 is +y; u = 0.5 + atan2(z, x) / 2pi. */
#ifndef EC_LIB_ENVIRONMENT_H
#define EC_LIB_ENVIRONMENT_H

#include "../shared/params.h"
#include "../shared/scene_buffers.h"
#include "distribution.h"
#include "patch.h"

typedef struct environment {
    constant ec_params *params;
    global const float *texels; /* R, G, B, scale of the patch right of and below the texel; the first row twice */
    global const uint *table;   /* ec_distribution_entry by word: of the rows of patches, then of each row's patches */
} environment;

/* Turns a direction of the scene into the frame of the map, which may be rotated; environment_from_map turns it back. */
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

/* v comes from atan2: acos(y) would lose half the digits at the poles. */
EC_FN void environment_uv(v3 d, lane_f *u, lane_f *v)
{
    *u = 0.5f + atan2_over_2pi(d.z, d.x);
    *v = 2.0f * fabs(atan2_over_2pi(sqrt(fma(d.x, d.x, d.z * d.z)), d.y));
}

/* A rectangle between the centres of four texels, or half of one between the centres of the first or last row and the pole. Its edges are named by
 * the nearer pole: south of the equator the near edge is the lower one, and small distances keep their digits. */
typedef struct environment_patch {
    v3 near_left, near_right, far_left, far_right;
    lane_f scale;            /* scale of the density: probability of the patch over the integral of luminance times sine */
    lane_f sin_near, sin_far; /* sines of the polar angle at both edges */
} environment_patch;

/* near: number of rows between the pole and the near edge, 0 for patches at the pole. */
EC_FN environment_patch environment_patch_load(const environment *e, lane_i near, lane_i south, lane_i x)
{
    int width = (int)e->params->environment_width, height = (int)e->params->environment_height;
    lane_i y = south ? height - near : near, below = min(y + 1, I(height)), right = x + 1 == width ? I(0) : x + 1; /* the seam wraps */
    quad q = gather_quad(e->texels, int_to_lane_u(y * width + x) * 4u), r = gather_quad(e->texels, int_to_lane_u(y * width + right) * 4u);
    quad s = gather_quad(e->texels, int_to_lane_u(below * width + x) * 4u), t = gather_quad(e->texels, int_to_lane_u(below * width + right) * 4u);
    environment_patch p;
    v3 upper_left = v3_make(q.a, q.b, q.c), upper_right = v3_make(r.a, r.b, r.c);
    v3 lower_left = v3_make(s.a, s.b, s.c), lower_right = v3_make(t.a, t.b, t.c);
    p.near_left = v3_select(south, lower_left, upper_left);
    p.near_right = v3_select(south, lower_right, upper_right);
    p.far_left = v3_select(south, upper_left, lower_left);
    p.far_right = v3_select(south, upper_right, lower_right);
    p.scale = q.d;
    lane_f unused, row = int_to_lane_f(near), half_turn = F(0.5f / (float)height);
    p.sin_near = sincos_2pi(max(row - 0.5f, F(0.0f)) * half_turn, &unused);
    p.sin_far = sincos_2pi((row + 0.5f) * half_turn, &unused);
    return p;
}

/* Returns the radiance at s (from left to right) and t (from the near to the far edge), without the map's factor. */
EC_FN v3 environment_patch_value(const environment_patch *p, lane_f s, lane_f t)
{
    v3 near = v3_fma(p->near_right, s, v3_scale(p->near_left, 1.0f - s)), far = v3_fma(p->far_right, s, v3_scale(p->far_left, 1.0f - s));
    return v3_fma(far, t, v3_scale(near, 1.0f - t));
}

/* Returns the pdf per solid angle with which light sampling picks a direction of the patch, the choice of this light included. Samples are
 * distributed by luminance times a sine that is linear over the patch, hence the quotient of that and the sine itself. sin_theta: 0 at the pole. */
EC_FN lane_f environment_patch_pdf(const environment *e, const environment_patch *p, v3 radiance, lane_f t, lane_f sin_theta)
{
    lane_f sine = fma(p->sin_far, t, p->sin_near * (1.0f - t)), at_pole = p->sin_far * ((float)e->params->environment_height * 2.0f * EC_INV_PI);
    lane_f share = sin_theta > 0.0f ? sine / sin_theta : at_pole;
    return luminance(radiance) * p->scale * share * e->params->environment_pmf;
}

/* Returns the radiance from direction d (unit); *pdf: the density of light sampling for it. */
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
    environment_uv(v3_make(d.x, fabs(d.y), d.z), &u, &v);
    int width = (int)e->params->environment_width, height = (int)e->params->environment_height;
    lane_f x = fma(u, F((float)width), F(-0.5f)), column = floor(x), y = v * (float)height;
    lane_f row = min(floor(y + 0.5f), F((float)(height / 2)));
    lane_i left = to_lane_i(column), near = to_lane_i(row);
    left = min(left < 0 ? I(width - 1) : left, I(width - 1));
    lane_f t = min(near == 0 ? 2.0f * y : y + 0.5f - row, F(1.0f));
    environment_patch p = environment_patch_load(e, near, d.y < 0.0f, left);
    v3 radiance = environment_patch_value(&p, x - column, t);
    *pdf = environment_patch_pdf(e, &p, radiance, t, sqrt(fma(d.x, d.x, d.z * d.z)));
    return v3_mul(radiance, factor);
}

/* Samples a direction by importance: r2 chooses a row of patches and r1 a patch of it; what is left of both chooses the point in the patch. */
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
    lane_u y = distribution_sample(e->table, U(0), height + 1u, r2, &in_y);
    lane_u x = distribution_sample(e->table, y * width + (height + 1u), width, r1, &in_x);
    lane_i south = y > height / 2u, near = uint_to_lane_i(south ? U(height) - y : y);
    environment_patch p = environment_patch_load(e, near, south, uint_to_lane_i(x));
    lane_f near_left = luminance(p.near_left), near_right = luminance(p.near_right);
    lane_f far_left = luminance(p.far_left), far_right = luminance(p.far_right);
    lane_f t = patch_along(near_left + near_right, far_left + far_right, p.sin_near, p.sin_far, in_y);
    lane_f s = patch_across(fma(far_left, t, near_left * (1.0f - t)), fma(far_right, t, near_right * (1.0f - t)), in_x);
    lane_f u = (to_lane_f(x) + 0.5f + s) / (float)width, rows = near == 0 ? 0.5f * t : int_to_lane_f(near) - 0.5f + t;
    lane_f cos_theta, sin_theta = sincos_2pi(rows * (0.5f / (float)height), &cos_theta);
    lane_f sin_phi = sincos_2pi(u > 1.0f ? u - 1.0f : u, &cosine); /* u = 0.5 + phi / 2pi, which changes both signs */
    v3 value = environment_patch_value(&p, s, t);
    *pdf = environment_patch_pdf(e, &p, value, t, sin_theta);
    *radiance = v3_mul(value, factor);
    return environment_from_map(e, v3_make(-sin_theta * cosine, south ? -cos_theta : cos_theta, -sin_theta * sin_phi));
}

#endif
