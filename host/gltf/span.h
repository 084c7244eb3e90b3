/* Finds the box that a scene keeps within while it moves. Inside host/gltf/ only. */
#ifndef EC_GLTF_SPAN_H
#define EC_GLTF_SPAN_H

#include "gltf/gltf.h"

enum { EC_SPAN_STEPS = 64 };

/* Samples equal time steps from 0 to `seconds`; the box is in the world, and inverted (low > high) if there is nothing. The document is left posed at
 * the last time. */
ec_result ec_gltf_span(ec_gltf *gltf, const ec_scene_choice *choice, double seconds, double low[3], double high[3], ec_error *err);

#endif
