/* Builds the light tree of kernels/shared/light_tree.h. Inside host/pack only. */
#ifndef EC_PACK_LIGHT_TREE_H
#define EC_PACK_LIGHT_TREE_H

#include "pack/light_bounds.h"
#include "pack/pack.h"

/* The lamps to build a tree of. */
typedef struct ec_light_set {
    uint32_t count;                /* at least 2, which are not all in one bulb */
    const ec_light_bounds *bounds;
    const uint32_t *ids;           /* places in the table; those of a bulb's lamps are consecutive */
    uint32_t bulb_count;
    const ec_bulb *bulbs;          /* ranges of bounds, in order */
} ec_light_set;

/* Returns the number of nodes, including the records of bulbs; 2 count - 1 if there is no bulb. */
size_t ec_light_tree_nodes(const ec_light_set *set);

/* Builds the tree into the caller's arrays: so many nodes, and a trail for each lamp. The bytes do not depend on the number of threads. O(count log
 * count). */
ec_result ec_light_tree_build(const ec_light_set *set, ec_light_node *nodes, uint32_t *trails, ec_error *err);

#endif
