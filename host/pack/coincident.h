/* Finds emitting triangles that coincide exactly, as when a mesh is there twice. Inside host/pack only. */
#ifndef EC_PACK_COINCIDENT_H
#define EC_PACK_COINCIDENT_H

#include <stdbool.h>

#include "pack/pack.h"

/* Finds, for every triangle of an emitting material, the first emitting triangle with the same corners and front, both two-sided or neither; often
 * itself. Rays meet only that one, so light sampling must count it once. malloc'ed; other entries are undefined. Lamps back to back, or shifted in
 * their plane, remain two: of those a ray meets the one that faces it (kernels/lib/coplanar.h). */
ec_result ec_coincident_find(const ec_scene *scene, const ec_pack *pack, const bool *emits, uint32_t **first, ec_error *err);

#endif
