/* lib/light.h, light_centre.h, environment.h, texture.h, camera.h, raster.h */
#ifndef EC_PRECISION_KERNEL_LIGHT_H
#define EC_PRECISION_KERNEL_LIGHT_H

#include "lib/camera.h"
#include "lib/light_centre.h"
#include "lib/raster.h"
#include "kernel_surface.h"

/* Words: p 0; the light's record 3; u 19. */
#define PRECISION_RECORD 3
EC_FN light_record light_of(global const float *in)
{
    lights l = {in + PRECISION_RECORD, 0, {0, 0, 0}, 0};
    return light_load(&l, ITEM * (EC_PRECISION_WORDS / EC_LIGHT_WORDS));
}

/* Results that are not valid are not compared. A direction may be off by u edge / height: spherical_triangle.h. */
PRECISION(light_sample_triangle)
{
    geometry g = geometry_of(in, memory);
    light_record l = light_of(in);
    lamp_part whole = lamp_part_all();
    light_sample s = light_sample_triangle(&l, &g, &whole, TRUE_MASK, V(0), X(19), X(20));
    PUT_V(0, v3_select(s.valid, s.wi, v3_zero()));
    v3 e1 = v3_sub(l.b, l.a), e2 = v3_sub(l.c, l.a);
    lane_f height = fabs(v3_dot(v3_sub(l.a, V(0)), s.end_normal));
    PUT(3, sqrt(max(v3_dot(e1, e1), v3_dot(e2, e2))) / height);
    PUT_V(4, v3_select(s.valid, s.towards, v3_zero()));
    PUT(7, s.valid ? s.pdf : F(0.0f));
    PUT_V(8, s.end_normal);
    PUT_V(11, s.end_error);
}
/* The function takes one light for all lanes, so lanes are computed one by one. */
PRECISION(light_from_centre)
{
    geometry g = geometry_of(in, memory);
    for (uint k = 0; k < LANES; k++) {
        global const float *w = in + (get_global_id(0) * LANES + k) * EC_PRECISION_WORDS;
        light_sample s = light_from_centre(w + PRECISION_RECORD, 0u, &g, TRUE_MASK, v3_make(F(w[0]), F(w[1]), F(w[2])), 1.0f);
        v3 radiance = v3_select(s.valid, s.radiance, v3_zero());
        scatter_f(out, ITEM * EC_PRECISION_RESULTS, radiance.x, 1u << k);
        scatter_f(out + 1, ITEM * EC_PRECISION_RESULTS, radiance.y, 1u << k);
        scatter_f(out + 2, ITEM * EC_PRECISION_RESULTS, radiance.z, 1u << k);
    }
}
PRECISION(light_sample_punctual)
{
    light_record l = light_of(in);
    light_sample s = light_sample_punctual(&l, TRUE_MASK, V(0), 1.0f);
    PUT_V(0, s.wi);
    PUT_V(3, s.radiance);
}

EC_FN environment environment_of(global const float *memory, constant ec_params *params)
{
    environment e = {params, memory + EC_PRECISION_MAP, (global const uint *)(memory + EC_PRECISION_TABLE)};
    return e;
}
PRECISION(environment_uv)
{
    lane_f u, v;
    environment_uv(V(0), &u, &v);
    PUT(0, u);
    PUT(1, F(0.5f));
    PUT(2, v);
}
/* Words: the ends of both linear functions, u. The scale of a position is 1. */
PRECISION(patch)
{
    PUT(0, patch_across(X(0), X(1), X(4)));
    PUT(1, F(1.0f));
    PUT(2, patch_along(X(0), X(1), X(2), X(3), X(4)));
    PUT(3, F(1.0f));
}
PRECISION(environment_look_up)
{
    environment e = environment_of(memory, params);
    lane_f pdf;
    PUT_V(0, environment_look_up(&e, V(0), &pdf));
    PUT(3, pdf);
}
PRECISION(environment_sample)
{
    environment e = environment_of(memory, params);
    lane_f pdf;
    v3 radiance, wi = environment_sample(&e, BITS(0), BITS(1), &pdf, &radiance);
    PUT_V(0, wi);
    PUT_V(3, radiance);
    PUT(6, pdf);
}
PRECISION(environment_sample_constant)
{
    environment e = {params, 0, 0};
    lane_f pdf;
    v3 radiance, wi = environment_sample(&e, BITS(0), BITS(1), &pdf, &radiance);
    PUT(0, wi.x);
    PUT(1, wi.y);
    PUT(2, wi.z);
}

PRECISION(texture_sample)
{
    geometry g = geometry_of(in, memory);
    rgba t = texture_sample(g.tex, TRUE_MASK, gather_quad(g.tex.table, BITS(0) * 4u), X(1), X(2), false);
    PUT_V(0, t.rgb);
}
PRECISION(camera_sample)
{
    lane_u x, y;
    lane_f sx, sy;
    camera_sample(params, 0u, 0u, 0, 0, BITS(0), &x, &y, &sx, &sy);
    PUT(0, sx);
    PUT(1, sy);
    PUT(2, F(1.0f));
}
/* Words: p 0, q 3, right 6, up 9, forward 12. The function takes one triangle a work-item, so lanes are computed one by one. */
PRECISION(raster_edge)
{
    for (uint i = (uint)get_global_id(0) * LANES, end = i + LANES; i < end; i++) {
        global const float *w = in + i * EC_PRECISION_WORDS;
        view c = {point3_make(w[6], w[7], w[8]), point3_make(w[9], w[10], w[11]), point3_make(w[12], w[13], w[14]), false};
        raster_edge(&c, point3_make(w[0], w[1], w[2]), point3_make(w[3], w[4], w[5]), 1.0f, out + i * EC_PRECISION_RESULTS);
    }
}

#endif
