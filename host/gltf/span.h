/* The box that a scene keeps within while it moves. Inside host/gltf/ only. */
#ifndef EC_GLTF_SPAN_H
#define EC_GLTF_SPAN_H

#include "gltf/gltf.h"

enum { EC_SPAN_STEPS = 64 };

/* In the world, from 0 to `seconds` at equal times; a box without an inside where there is nothing. The document is left posed at the last one. */
ec_result ec_gltf_span(ec_gltf *gltf, const ec_scene_choice *choice, double seconds, double low[3], double high[3], ec_error *err);

#endif
