/* Keeps the trees of meshes that are stored once, from one build of two levels to the next. */
#ifndef EC_ACCEL_SHAPE_TREES_H
#define EC_ACCEL_SHAPE_TREES_H

#include <stdbool.h>

#include "accel/bvh.h"
#include "base/fingerprint.h"

typedef struct ec_shape_tree {
    ec_fingerprint key;      /* of the mesh's triangles in its own space */
    ec_bvh8 bvh;             /* owned; cuts no triangle, and so has no boxes */
    bool wanted;             /* by the current build */
} ec_shape_tree;

/* Zero-initialised: no trees. */
typedef struct ec_shape_trees { /* accel.h points to it */
    ec_shape_tree *list;
    uint32_t count, found, built; /* found, built: since ec_shape_trees_begin */
} ec_shape_trees;

void ec_shape_trees_begin(ec_shape_trees *trees);
const ec_shape_tree *ec_shape_trees_find(ec_shape_trees *trees, ec_fingerprint key); /* NULL: there is none; valid until the next add */
/* Adds a tree and takes it over, even on failure. */
ec_result ec_shape_trees_add(ec_shape_trees *trees, const ec_shape_tree *tree, ec_error *err);
void ec_shape_trees_end(ec_shape_trees *trees); /* frees those that were not wanted */
void ec_shape_trees_free(ec_shape_trees *trees);

#endif
