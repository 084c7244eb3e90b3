/* Shared by the parts of motion: motion.c reads the moments, motion_deviation.c decides how many keys they need, motion_keys.c makes these.
 * Inside host/gltf/ only. */
#ifndef EC_GLTF_MOTION_H
#define EC_GLTF_MOTION_H

#include "gltf/flatten_vertex.h"

#define EC_MOMENTS (2 * EC_MOTION_SEGMENTS_MOST) /* equal steps of the shutter that may be looked at */

/* Where everything is at the moments looked at: 0, step, 2 step, … EC_MOMENTS. */
typedef struct ec_tracks {
    const ec_scene_choice *choice;
    ec_gltf *base;                      /* posed at one moment after the other */
    bool *hidden;                       /* by node: in the middle of the exposure, and so all the time */
    ec_scene *scene;                    /* as in the middle of the exposure */
    uint32_t *vertex, count;            /* the scene's vertices that may move, ascending */
    uint32_t words, normals, tangents;  /* floats of one: its position, normal and tangent, and where these begin; 0: none */
    float *values[EC_MOMENTS + 1];      /* by place in `vertex` */
    ec_camera *cameras[EC_MOMENTS + 1]; /* as many as the scene has, without names */
    ec_light *lights[EC_MOMENTS + 1];
    uint32_t step, segments;
    double deviation;
} ec_tracks;

/* The numbers of one thing at a moment, so many of them. */
typedef const float *numbers_at(const ec_tracks *t, uint32_t moment, uint32_t thing);

static inline const float *vertex_at(const ec_tracks *t, uint32_t moment, uint32_t i)
{
    return t->values[moment] + (size_t)i * t->words;
}
/* Position, right, up, forward. */
static inline const float *camera_place(const ec_tracks *t, uint32_t moment, uint32_t i) { return t->cameras[moment][i].position; }
static inline const float *camera_view(const ec_tracks *t, uint32_t moment, uint32_t i) { return &t->cameras[moment][i].yfov; }
/* Position, direction. */
static inline const float *light_place(const ec_tracks *t, uint32_t moment, uint32_t i) { return t->lights[moment][i].position; }

/* Largest distance of `segments` straight lines from the moments looked at, over the box that a mesh sweeps; of directions over 1. */
double ec_tracks_deviation(const ec_tracks *tracks);

/* Drops triangles that have no area at any moment or no place at one, puts those that move first, with their keys. */
ec_result ec_tracks_keep(const ec_tracks *tracks, ec_scene *scene, const ec_log *log, ec_error *err);

#endif
