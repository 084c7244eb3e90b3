/* The tree of instances. Private to host/accel. */
#ifndef EC_ACCEL_TOP_H
#define EC_ACCEL_TOP_H

#include "accel/build_internal.h"

/* Writes 8-wide nodes over boxes [0 .. count) into nodes, the root first; leaves are EC_LEAF_BIT | EC_INSTANCE_BIT | box + 1.
 * Room for count + 1 nodes is enough. *used: how many there are. No path is longer than EC_TOP_DEPTH nodes. */
#define EC_TOP_DEPTH 12u /* eight children each: 7 x 12 entries wait on a traversal's stack, and 8^12 instances have room */
int ec_top_build(const ec_box *boxes, uint32_t count, ec_bvh8_node *nodes, uint32_t *used);

#endif
