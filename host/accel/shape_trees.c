#include "accel/shape_trees.h"

#include <stdlib.h>

static void free_tree(const ec_shape_tree *tree)
{
    free(tree->bvh.nodes);
    free(tree->bvh.blocks);
}

void ec_shape_trees_begin(ec_shape_trees *trees)
{
    trees->found = trees->built = 0;
    for (uint32_t i = 0; i < trees->count; i++) trees->list[i].wanted = false;
}

const ec_shape_tree *ec_shape_trees_find(ec_shape_trees *trees, ec_fingerprint key)
{
    for (uint32_t i = 0; i < trees->count; i++) {
        if (!ec_fingerprint_is(trees->list[i].key, key)) continue;
        trees->found++;
        trees->list[i].wanted = true;
        return &trees->list[i];
    }
    return NULL;
}

ec_result ec_shape_trees_add(ec_shape_trees *trees, const ec_shape_tree *tree, ec_error *err)
{
    ec_shape_tree *grown = realloc(trees->list, (trees->count + (size_t)1) * sizeof *grown);
    if (!grown) {
        free_tree(tree);
        return ec_fail(err, "out of memory for the trees of meshes");
    }
    trees->list = grown;
    trees->list[trees->count] = *tree;
    trees->list[trees->count++].wanted = true;
    trees->built++;
    return EC_OK;
}

void ec_shape_trees_end(ec_shape_trees *trees)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < trees->count; i++) {
        if (trees->list[i].wanted) trees->list[kept++] = trees->list[i];
        else free_tree(&trees->list[i]);
    }
    trees->count = kept;
}

void ec_shape_trees_free(ec_shape_trees *trees)
{
    ec_shape_trees_begin(trees);
    ec_shape_trees_end(trees);
    free(trees->list);
    *trees = (ec_shape_trees){0};
}
