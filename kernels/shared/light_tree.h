/* The light tree: lamps by where they are and where they shine. Nodes of twelve words; the root is node 0, a node's children stand
 * side by side. */
#ifndef EC_SHARED_LIGHT_TREE_H
#define EC_SHARED_LIGHT_TREE_H

#include "types.h"

typedef struct ec_light_node {
    ec_float centre[3], radius2;  /* a sphere around all of them */
    ec_float axis[3], cos_spread; /* a cone around their normals; -1: they shine all ways */
    ec_float power, sin_spread;   /* power relative to that of the strongest lamp */
    ec_uint link;                 /* first child; for a leaf EC_LIGHT_LEAF + the lamp's index in the table */
    ec_uint flags;                /* EC_LIGHT_NODE_* */
} ec_light_node;
EC_ASSERT_SIZE(ec_light_node, 48);
#define EC_LIGHT_NODE_WORDS 12
#define EC_LIGHT_LEAF 0x80000000u
#define EC_LIGHT_BULB 0x40000000u      /* with EC_LIGHT_LEAF, in place of a lamp: the node at which a bulb's record begins (kernels/lib/bulb.h) */
#define EC_LIGHT_NODE_TWO_SIDED 1u     /* some shine backwards too */
#define EC_LIGHT_NODE_BULB 2u          /* its lamps are a bulb; the record stands behind its two children */
#define EC_LIGHT_BULB_FAR 1.5f         /* a bulb is taken as one where the squared distance is above this many squared radii of its sphere */
#define EC_LIGHT_DEPTH_MOST 32 /* levels below the root: a lamp's trail has a bit for each, lowest first, 1 for the second child */

#endif
