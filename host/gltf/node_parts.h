/* Which nodes triangles are of. Inside host/scene/ only; what is made of it is ec_scene.parts. */
#ifndef EC_GLTF_NODE_PARTS_H
#define EC_GLTF_NODE_PARTS_H

#include "gltf/gltf.h"

/* Room for so many, and the nodes' names. */
ec_result ec_parts_start(ec_scene *scene, const ec_gltf *gltf, uint32_t most, ec_error *err);

/* Triangles from this id on are of that node. Ids rise. */
void ec_part_add(ec_scene *scene, uint32_t first, uint32_t node);

#endif
