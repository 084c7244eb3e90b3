/* What a camera can see of a scene, but for what hides what. */
#ifndef EC_SCENE_IN_SIGHT_H
#define EC_SCENE_IN_SIGHT_H

#include "scene/scene.h"

typedef enum ec_in_sight { EC_SIGHT_FRONTS, EC_SIGHT_BACKS, EC_SIGHT_NONE } ec_in_sight;

/* Fronts, or both-sided surfaces, if there is any in the camera's view; else backs of single-sided ones, which camera rays pass through; else
 * none. window: left, right, bottom and top of the picture in the plane at distance 1, or for an orthographic camera in its own units. With
 * meshes that are kept once, and with motion, EC_SIGHT_FRONTS: nobody looks. */
ec_in_sight ec_scene_in_sight(const ec_scene *scene, const ec_camera *camera, const double window[4]);

#endif
