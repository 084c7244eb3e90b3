/* Environments for the eye alone. */
#ifndef EC_SCENE_BLUR_H
#define EC_SCENE_BLUR_H

#include "scene/built_in.h"
#include "scene/scene.h"

/* A map, unturned, of the environment blurred by a bell of that standard deviation, up to 60 degrees; blurred->rgb is malloc'ed. */
ec_result ec_environment_blur(const ec_environment *environment, double degrees, ec_made_map *blurred, ec_error *err);

#endif
