/* Shared by the parts of motion: motion.c reads the moments, motion_deviation.c decides how many keys they need, motion_keys.c makes the keys. Inside
 * host/gltf/ only. */
#ifndef EC_GLTF_MOTION_H
#define EC_GLTF_MOTION_H

#include "gltf/flatten_vertex.h"

#define EC_MOMENTS (2 * EC_MOTION_SEGMENTS_MOST) /* the shutter is divided into at most so many equal steps */

/* The state of everything at the moments examined: 0, step, 2 step, … EC_MOMENTS. */
typedef struct ec_tracks {
    const ec_scene_choice *choice;
    ec_gltf *base;                      /* the document, posed at one moment after the other */
    bool *hidden;                       /* by node, in the middle of the exposure: held for all of it */
    ec_scene *scene;                    /* at the middle of the exposure */
    uint32_t *vertex, count;            /* vertices of the scene that may move, ascending */
    uint32_t words, normals, tangents;  /* floats per vertex, and where its normal and tangent begin; 0: none. The position is first */
    float *values[EC_MOMENTS + 1];      /* by index into `vertex` */
    ec_camera *cameras[EC_MOMENTS + 1]; /* as many as the scene has, without names */
    ec_light *lights[EC_MOMENTS + 1];
    uint32_t step, segments;
    double deviation;
} ec_tracks;

/* Returns the numbers of one thing at a moment. */
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

/* Returns the largest distance between the tracks and `segments` straight lines, relative to the box that a mesh sweeps; for directions, relative to
 * 1. */
double ec_tracks_deviation(const ec_tracks *tracks);

/* Drops triangles that have no area at any moment, or no finite position at some moment; puts those that move first, with their keys. */
ec_result ec_tracks_keep(const ec_tracks *tracks, ec_scene *scene, const ec_log *log, ec_error *err);

#endif
