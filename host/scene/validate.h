/* Establishes what every loaded scene guarantees to later steps. Inside host/scene/ and the tests. */
#ifndef EC_SCENE_VALIDATE_H
#define EC_SCENE_VALIDATE_H

#include "scene/scene.h"

/* Clamps material parameters to their ranges, with a warning for each material that needed it. */
void ec_scene_clamp_materials(ec_scene *scene, const char *path, const ec_log *log);

/* Checks that everything is finite, every index in range, and every frame and normal unit. A failure is a bug of the loader, not of the file; as it
 * is cheap beside building a BVH, it always runs. */
ec_result ec_scene_validate(const ec_scene *scene, ec_error *err);

/* Rotates neighbouring triangles that share an edge to (p, q, r), (p, r, s). */
void ec_scene_join_quads(ec_scene *scene);

#endif
