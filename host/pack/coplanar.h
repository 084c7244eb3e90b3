/* Triangles that lie on one another in one plane, for kernels/lib/coplanar.h. Inside host/pack only. */
#ifndef EC_PACK_COPLANAR_H
#define EC_PACK_COPLANAR_H

#include "pack/pack.h"

/* Fills pack->coplanar, and calls for the effect where there are any. Comes after prims and motion. Scenes with meshes that are kept once and
 * more than EC_MET_PRIMS_MOST triangles are left as they are. */
ec_result ec_pack_coplanar(const ec_scene *scene, ec_pack *pack, ec_error *err);

#endif
