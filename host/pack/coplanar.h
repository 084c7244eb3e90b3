/* Finds triangles that overlap in one plane, for kernels/lib/coplanar.h. Inside host/pack only. */
#ifndef EC_PACK_COPLANAR_H
#define EC_PACK_COPLANAR_H

#include "pack/pack.h"

/* Fills pack->coplanar, and calls for the effect if there are any. To be called after prims and motion. Skips scenes in which meshes are kept once
 * and that have more than EC_MET_PRIMS_MOST triangles. */
ec_result ec_pack_coplanar(const ec_scene *scene, ec_pack *pack, ec_error *err);

#endif
