/* Makes blurred environments, which only the eye sees: they light nothing. */
#ifndef EC_SCENE_BLUR_H
#define EC_SCENE_BLUR_H

#include "scene/built_in.h"
#include "scene/scene.h"

/* Blurs the environment by a bell-shaped filter of this standard deviation, up to 60 degrees, into an unturned map; blurred->rgb is malloc'ed. */
ec_result ec_environment_blur(const ec_environment *environment, double degrees, ec_made_map *blurred, ec_error *err);

#endif
