/* Casters: spheres around whatever bends or mirrors light sharply, at which light paths are aimed, and how much each light sends to them
 * (kernels/lib/light_path.h). Inside host/pack, except for the declarations in pack.h. */
#ifndef EC_PACK_CASTERS_H
#define EC_PACK_CASTERS_H

#include "pack/pack.h"

/* Offsets of the parts of ec_pack.emission, in words. */
static inline size_t ec_emission_trails(uint32_t lights) { return 3 * (size_t)lights; }
static inline size_t ec_emission_prims(uint32_t lights) { return 4 * (size_t)lights; }

#endif
