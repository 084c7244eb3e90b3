/* Finds where the camera sees a point, for light paths: the inverse of camera_sample, lens_shift and ec_generate. */
#ifndef EC_LIB_FILM_POINT_H
#define EC_LIB_FILM_POINT_H

#include "camera_axes.h"
#include "film.h"
#include "lens.h"
#include "pixel_filter.h"
#include "sampler.h"

typedef struct film_point {
    v3 o, to_camera; /* origin of the camera ray; unit direction from the point to it */
    lane_f way2;     /* squared distance of the two */
    lane_f area;     /* M of light_path.h for one light path per camera path: at the point, across the ray, a camera path has density 1 / area */
    lane_f weight;   /* sum of all pixels' filters there */
    lane_u place;    /* index in the film of the pixel that it counts for */
    lane_i seen;     /* lanes that have such a pixel */
} film_point;

/* Projects p onto the film. u1, u2 choose the point of the lens; u_x, u_y the pixel. */
EC_FN film_point film_point_of(constant ec_params *params, const camera_axes *v, global const float *filter, v3 p, lane_f u1, lane_f u2, lane_f u_x,
                               lane_f u_y)
{
    film_point f;
    v3 lens = HAS(LENS) && !params->orthographic ? lens_point(v, u1, u2) : v3_zero(), in_plane;
    f.o = v3_add(v->origin, lens);
    v3 way = v3_sub(p, f.o);
    lane_f depth = v3_dot(way, v->forward), cosine = F(1.0f);
    if (params->orthographic) {
        in_plane = v3_fma(v->forward, -depth, way);
        f.o = v3_fma(v->forward, -depth, p);
        f.to_camera = v3_negate(v->forward);
        f.way2 = depth * depth;
        f.area = F(params->film_area);
    } else {
        in_plane = v3_fma(lens, F(params->lens_nearness), v3_sub(v3_scale(way, 1.0f / depth), v->forward));
        f.way2 = v3_dot(way, way);
        f.to_camera = v3_scale(way, -1.0f / sqrt(f.way2));
        cosine = -v3_dot(f.to_camera, v->forward);
        f.area = f.way2 * F(params->film_area) * cosine * cosine * cosine;
    }
    lane_f sx = v3_dot(in_plane, v->right) / v3_dot(v->right, v->right), sy = v3_dot(in_plane, v->up) / v3_dot(v->up, v->up);
    lane_f weight_x, weight_y;
    lane_f x = pixel_filter_choose(filter, (sx - params->screen[0]) / params->screen[2], u_x, &weight_x);
    lane_f y = pixel_filter_choose(filter, (sy - params->screen[1]) / params->screen[3], u_y, &weight_y);
    f.weight = weight_x * weight_y;
    y -= (float)params->film_row;
    f.seen = (depth > 0.0f) & (x >= 0.0f) & (x < (float)params->width) & (y >= 0.0f) & (y < (float)params->film_rows) & (f.weight > 0.0f);
    f.place = int_to_lane_u(to_lane_i(f.seen ? y : F(0.0f))) * params->width + int_to_lane_u(to_lane_i(f.seen ? x : F(0.0f)));
    return f;
}

#endif
