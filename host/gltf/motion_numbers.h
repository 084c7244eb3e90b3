/* The numbers of tracks one by one, whatever they belong to. Inside host/gltf/motion*.c only. */
#ifndef EC_GLTF_MOTION_NUMBERS_H
#define EC_GLTF_MOTION_NUMBERS_H

#include "gltf/motion.h"

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

#endif
