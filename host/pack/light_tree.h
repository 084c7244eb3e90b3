/* The light tree of kernels/shared/light_tree.h. Inside host/pack only. */
#ifndef EC_PACK_LIGHT_TREE_H
#define EC_PACK_LIGHT_TREE_H

#include "pack/light_bounds.h"

/* Over `count` lamps (at least 2): 2 count - 1 nodes and a trail for each lamp, both the caller's to make room for. ids: the lamps'
 * places in the table, by bounds. The same bytes whatever computes it. O(count log count). */
ec_result ec_light_tree_build(const ec_light_bounds *bounds, const uint32_t *ids, uint32_t count, ec_light_node *nodes,
                              uint32_t *trails, ec_error *err);

#endif
