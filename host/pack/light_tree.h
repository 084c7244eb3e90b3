/* The light tree of kernels/shared/light_tree.h. Inside host/pack only. */
#ifndef EC_PACK_LIGHT_TREE_H
#define EC_PACK_LIGHT_TREE_H

#include "pack/light_bounds.h"
#include "pack/pack.h"

/* Lamps to make a tree of. */
typedef struct ec_light_set {
    uint32_t count;                /* at least 2, and more than one bulb */
    const ec_light_bounds *bounds;
    const uint32_t *ids;           /* their places in the table; of a bulb's lamps places in turn */
    uint32_t bulb_count;
    const ec_bulb *bulbs;          /* by bounds, in order */
} ec_light_set;

/* Nodes of the tree, bulbs' records among them: 2 count - 1 where there is no bulb. */
size_t ec_light_tree_nodes(const ec_light_set *set);

/* So many nodes, and a trail for each lamp, both the caller's to make room for. The same bytes whatever computes it. O(count log count). */
ec_result ec_light_tree_build(const ec_light_set *set, ec_light_node *nodes, uint32_t *trails, ec_error *err);

#endif
