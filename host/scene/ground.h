/* A ground under a scene: content as any other, but made by us. */
#ifndef EC_SCENE_GROUND_H
#define EC_SCENE_GROUND_H

#include "scene/scene.h"

/* The floor reaches so many times as far as the scene's bounding sphere. */
#define EC_GROUND_REACH 12

/* Adds a square of two triangles, matte and of reflectance 0.5, that faces +y a hair under the lowest point, of a frame under that of its whole animation; ids of placed triangles move up by two.
 * Fails where the scene has no surface. On failure the scene is as it was. */
ec_result ec_scene_add_ground(ec_scene *scene, ec_error *err);

#endif
