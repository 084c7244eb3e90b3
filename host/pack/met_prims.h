/* Triangles as rays meet them, by id. Inside host/pack only. */
#ifndef EC_PACK_MET_PRIMS_H
#define EC_PACK_MET_PRIMS_H

#include "pack/pack.h"

#define EC_MET_PRIMS_MOST (1u << 21) /* 96 MiB */

/* Lists triangles placed in the world, and those of meshes kept once at each of their places. *met: by id; malloc'ed, or pack->prims itself if no
 * mesh is kept once, or NULL if there are more than EC_MET_PRIMS_MOST. */
ec_result ec_pack_met_prims(const ec_scene *scene, const ec_pack *pack, ec_prim **met, uint32_t *count, ec_error *err);

#endif
