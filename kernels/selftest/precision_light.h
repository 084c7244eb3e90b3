/* lib/light.h, light_centre.h, environment.h, texture.h, camera.h, raster.h */
#ifndef EC_SELFTEST_PRECISION_LIGHT_H
#define EC_SELFTEST_PRECISION_LIGHT_H

#include "../lib/camera.h"
#include "../lib/light_centre.h"
#include "../lib/raster.h"
#include "precision_surface.h"

/* Words: p 0, vertices 3, u 12, pmf and pdf_a 14, emission 16. */
EC_FN light_record light_of(global const float *in, lane_u kind)
{
    light_record r = {V(3), V(6), V(9), V(16), kind, U(0), X(14), X(15)};
    return r;
}
PRECISION(light_sample_triangle)
{
    geometry g = geometry_of(in, memory);
    light_record l = light_of(in, U(EC_KIND_TRIANGLE | EC_LIGHT_TWO_SIDED));
    light_sample s = light_sample_triangle(&l, &g, TRUE_MASK, V(0), X(12), X(13));
    PUT_V(0, s.wi);
    PUT_V(3, s.towards);
    PUT(6, s.pdf);
    PUT_V(7, s.end_normal);
    PUT_V(10, s.end_error);
}
PRECISION(light_from_centre)
{
    light_record l = light_of(in, U(EC_KIND_TRIANGLE | EC_LIGHT_TWO_SIDED));
    geometry g = geometry_of(in, memory);
    light_sample s = light_sample_triangle(&l, &g, TRUE_MASK, V(0), F(4.0f / 9.0f), F(0.5f));
    PUT_V(0, v3_scale(s.radiance, l.pmf / s.pdf));
}
/* Words: p 0, position 3, direction 6, cone and range 9, intensity 16. */
PRECISION(light_sample_punctual)
{
    light_record l = light_of(in, U(EC_KIND_SPOT));
    light_sample s = light_sample_punctual(&l, TRUE_MASK, V(0), 1.0f);
    PUT_V(0, s.wi);
    PUT_V(3, s.radiance);
}

EC_FN environment environment_of(global const float *memory, constant ec_params *params)
{
    environment e = {params, memory + EC_PRECISION_MAP, (global const uint *)(memory + EC_PRECISION_ALIAS)};
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
    v3 radiance, wi = environment_sample(&e, BITS(0), X(1), X(2), &pdf, &radiance);
    PUT_V(0, wi);
    PUT_V(3, radiance);
    PUT(6, pdf);
}
PRECISION(environment_sample_constant)
{
    environment e = {params, 0, 0};
    lane_f pdf;
    v3 radiance, wi = environment_sample(&e, BITS(0), X(1), X(2), &pdf, &radiance);
    PUT(0, wi.x);
    PUT(1, wi.y);
    PUT(2, wi.z);
}

PRECISION(texture_sample)
{
    geometry g = geometry_of(in, memory);
    rgba t = texture_sample(g.tex, TRUE_MASK, uint_to_lane_i(BITS(0)), X(1), X(2), false);
    PUT_V(0, t.rgb);
}
PRECISION(camera_sample)
{
    lane_u x, y;
    lane_f sx, sy;
    camera_sample(params, 0u, 0u, 0, BITS(0), &x, &y, &sx, &sy);
    PUT(0, sx);
    PUT(1, sy);
    PUT(2, F(1.0f));
}
/* Words: p 0, q 3, right 6, up 9, forward 12. One triangle a work-item where it is used, so one lane after the other. */
PRECISION(raster_edge)
{
    for (uint i = (uint)get_global_id(0) * LANES, end = i + LANES; i < end; i++) {
        global const float *w = in + i * EC_PRECISION_WORDS;
        view c = {point3_make(w[6], w[7], w[8]), point3_make(w[9], w[10], w[11]), point3_make(w[12], w[13], w[14]), false};
        raster_edge(&c, point3_make(w[0], w[1], w[2]), point3_make(w[3], w[4], w[5]), 1.0f, out + i * EC_PRECISION_RESULTS);
    }
}

#endif
