/* Finds pairs of triangles that may touch. Inside host/pack only. */
#ifndef EC_PACK_NEAR_PAIRS_H
#define EC_PACK_NEAR_PAIRS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"
#include "shared/scene_buffers.h"

/* Receives each pair of triangles a < b whose boxes touch once, in no particular order, from several threads at once. Returning false ends the
 * search. */
typedef bool (*ec_pair_visit)(void *user, uint32_t a, uint32_t b);

/* Widens boxes by `margin` on all sides. Uses 32 bytes per triangle temporarily. */
ec_result ec_near_pairs(const ec_prim *prims, uint32_t count, float margin, ec_pair_visit visit, void *user, ec_error *err);

#endif
