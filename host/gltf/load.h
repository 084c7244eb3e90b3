/* Inside host/scene/ only. */
#ifndef EC_GLTF_LOAD_H
#define EC_GLTF_LOAD_H

#include "gltf/gltf.h"

/* The choice with the moment that a shutter stands for: its middle. */
ec_result ec_settle_moment(const char *path, const ec_scene_choice *choice, ec_scene_choice *moment, ec_error *err);

#endif
