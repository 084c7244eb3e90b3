/* Adds a ground under a scene, which is then content like any other. */
#ifndef EC_SCENE_GROUND_H
#define EC_SCENE_GROUND_H

#include "scene/scene.h"

/* Half the side of the ground, over the radius of the scene's bounding sphere. */
#define EC_GROUND_REACH 12

/* Adds a square of two triangles, matte with reflectance 0.5, that faces +y slightly below the lowest point of the scene or, for a frame, of its
 * whole animation; ids of placed triangles rise by two. Fails, and leaves the scene unchanged, if the scene has no surface or there is no memory. */
ec_result ec_scene_add_ground(ec_scene *scene, ec_error *err);

#endif
