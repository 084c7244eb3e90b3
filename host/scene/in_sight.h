/* Finds what a camera can see of a scene, without regard to occlusion. */
#ifndef EC_SCENE_IN_SIGHT_H
#define EC_SCENE_IN_SIGHT_H

#include "scene/scene.h"

typedef enum ec_in_sight { EC_SIGHT_FRONTS, EC_SIGHT_BACKS, EC_SIGHT_NONE } ec_in_sight;

/* Returns EC_SIGHT_FRONTS if a front or a double-sided surface is in the camera's view; otherwise EC_SIGHT_BACKS if a back of a single-sided surface
 * is, which camera rays pass through; otherwise EC_SIGHT_NONE. window: left, right, bottom and top of the picture in the plane at distance 1 or, for
 * an orthographic camera, in its own units. Scenes with motion or meshes that are kept once are not examined, and give EC_SIGHT_FRONTS. */
ec_in_sight ec_scene_in_sight(const ec_scene *scene, const ec_camera *camera, const double window[4]);

#endif
