/* Motion vectors: by how many pixels what a sample meets moves in the picture while the shutter is open. */
#ifndef EC_LIB_MOTION_VECTOR_H
#define EC_LIB_MOTION_VECTOR_H

#include "camera_axes.h"
#include "geometry.h"
#include "slot_layers.h"

/* Projects `place` (a direction where is_far) to pixels from the picture's top left corner. *before: it is in front of the camera. */
EC_FN void seen_at(constant ec_params *params, const camera_axes *v, v3 place, lane_i is_far, lane_f *x, lane_f *y, lane_i *before)
{
    v3 way = v3_select(is_far, place, v3_sub(place, v->origin));
    lane_f depth = params->orthographic ? F(1.0f) : v3_dot(way, v->forward) / v3_dot(v->forward, v->forward);
    *before = depth > 0.0f;
    *x = (v3_dot(way, v->right) / (v3_dot(v->right, v->right) * depth) - params->screen[0]) / params->screen[2];
    *y = (v3_dot(way, v->up) / (v3_dot(v->up, v->up) * depth) - params->screen[1]) / params->screen[3];
}

/* Returns the hit's point on its triangle at a moment. */
EC_FN v3 hit_point_at(global const float *motion, const hit_point *h, lane_u prim, lane_i moves, moment t)
{
    v3 p0 = h->p0, p1 = h->p1, p2 = h->p2;
    if (any_lane(moves)) motion_corners_at(motion, t, moves, prim, &p0, &p1, &p2);
    return v3_fma(p2, h->b2, v3_fma(p1, h->b1, v3_scale(p0, h->b0)));
}

/* Stores motion vectors on the lanes `active`. Rays that have not `found` a surface see a point at infinity along d. A point that is behind the
 * camera at either end has no vector. */
EC_FN void store_motion_vector(constant ec_params *params, global float *radiance, global const float *motion, global const float *camera_keys, lane_u slot,
                               const hit_point *h, lane_u prim, v3 d, lane_i active, lane_i found)
{
    const moment opens = {U(0), F(0.0f)}, closes = moment_of_end(motion);
    camera_axes first = camera_axes_make(params), last = first;
    lane_i moves = found & motion_moves(motion, prim) & !h->placed, before[2];
    lane_f x[2], y[2];
    if (camera_keys) {
        first = camera_axes_between(camera_keys, motion, opens);
        last = camera_axes_between(camera_keys, motion, closes);
    }
    seen_at(params, &first, v3_select(found, hit_point_at(motion, h, prim, moves, opens), d), !found, &x[0], &y[0], &before[0]);
    seen_at(params, &last, v3_select(found, hit_point_at(motion, h, prim, moves, closes), d), !found, &x[1], &y[1], &before[1]);
    v3 vector = v3_make(x[1] - x[0], y[1] - y[0], F(0.0f));
    store_layer(params, radiance, params->layer_of[EC_LAYER_MOTION], slot, vector, mask_bits(active & before[0] & before[1] & v3_is_finite(vector)));
}

#endif
