/* The camera's position and axes: fixed, or interpolated at the paths' times. */
#ifndef EC_LIB_CAMERA_AXES_H
#define EC_LIB_CAMERA_AXES_H

#include "../shared/params.h"
#include "motion.h"

/* The first vectors of ec_params, in their order. */
typedef struct camera_axes {
    v3 origin, right, up, forward, lens_right, lens_up;
} camera_axes;

EC_FN v3 axes_vector(constant float *p) { return v3_make(F(p[0]), F(p[1]), F(p[2])); }
EC_FN camera_axes camera_axes_make(constant ec_params *params)
{
    camera_axes v = {axes_vector(params->camera_origin), axes_vector(params->camera_right), axes_vector(params->camera_up),
              axes_vector(params->camera_forward), axes_vector(params->lens_right), axes_vector(params->lens_up)};
    return v;
}

/* Interpolates a vector between its keys. keys: for each of EC_CAMERA_VECTORS vectors its keys side by side, four words each. */
EC_FN v3 axes_between(global const float *keys, uint segments, uint vector, moment t)
{
    lane_u at = (t.key + vector * (segments + 1u)) * 4u;
    quad a = gather_quad(keys, at), b = gather_quad(keys, at + 4u);
    return v3_make(fma(t.share, b.a - a.a, a.a), fma(t.share, b.b - a.b, a.b), fma(t.share, b.c - a.c, a.c));
}
EC_FN camera_axes camera_axes_between(global const float *keys, global const float *motion, moment t)
{
    uint segments = ((global const uint *)motion)[EC_MOTION_SEGMENTS];
    camera_axes v = {axes_between(keys, segments, 0, t), axes_between(keys, segments, 1, t),
                     axes_between(keys, segments, 2, t), v3_normalize(axes_between(keys, segments, 3, t)),
                     axes_between(keys, segments, 4, t), axes_between(keys, segments, 5, t)};
    return v;
}
EC_FN camera_axes camera_axes_at(global const float *keys, global const float *motion, lane_f time)
{
    return camera_axes_between(keys, motion, moment_of(motion, time));
}

#endif
