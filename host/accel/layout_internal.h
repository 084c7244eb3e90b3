/* Shared by the two layouts. Private to host/accel. */
#ifndef EC_ACCEL_LAYOUT_INTERNAL_H
#define EC_ACCEL_LAYOUT_INTERNAL_H

#include <stddef.h>

#include "accel/build_internal.h"

/* Facts about the subtree below a node that the node itself does not hold. */
typedef struct ec_subtree {
    uint32_t count;  /* references: order[node.first .. node.first + count) */
    uint32_t height; /* edges down to the deepest leaf */
} ec_subtree;

/* Returns one entry for each node; malloc'ed and the caller's, NULL when out of memory. */
ec_subtree *ec_bvh_subtrees(const ec_bvh *bvh);

/* collapse8.c: how to use eight children. slots[n][j]: of the j children that node n may become, how many its left child becomes; 0: as with j - 1.
 * slots[n][1]: 0 = a leaf block, 1 = a node of its own, whose children slots[n][8] says. */
typedef struct ec_collapse {
    uint8_t (*slots)[9];
} ec_collapse;
int ec_collapse8(const ec_bvh *bvh, const ec_subtree *subtrees, ec_collapse *collapse);

/* occlusion.c: returns how promising each node is to a shadow ray inside it; one for each node, malloc'ed and the caller's, NULL when out of memory. */
float *ec_bvh_promises(const ec_bvh *bvh);

/* sweep.c: exact SAH over at most EC_SWEEP_MAX triangles, for leaves of at most EC_SWEEP_LEAF that are tested triangle
 * by triangle. Reorders ids, and boxes with them (NULL: the triangles' own); appends to nodes (children numbered within
 * them) and returns the reference to the root, whose leaves count triangles from `first`. */
#define EC_SWEEP_MAX 64u
#define EC_SWEEP_LEAF 4u
uint32_t ec_sweep_build(const float *positions, const uint32_t *indices, uint32_t *ids, ec_box *boxes, uint32_t count,
                        uint32_t first, uint32_t depth, ec_bvh2_node *nodes, uint32_t *node_count);

#endif
