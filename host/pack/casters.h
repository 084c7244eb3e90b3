/* What bends or mirrors light sharply, as spheres that light paths are aimed at, and which lights send them (kernels/lib/light_path.h). Inside
 * host/pack, but for what pack.h has of it. */
#ifndef EC_PACK_CASTERS_H
#define EC_PACK_CASTERS_H

#include "pack/pack.h"

/* Words of ec_pack.emission. */
static inline size_t ec_emission_trails(uint32_t lights) { return 3 * (size_t)lights; }
static inline size_t ec_emission_prims(uint32_t lights) { return 4 * (size_t)lights; }

#endif
