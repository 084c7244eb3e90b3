/* Joins pieces of a tree that were built separately, in an order that does not depend on who built them. */
#include <stdlib.h>
#include <string.h>

#include "accel/build_internal.h"

#define TASK_TRIANGLES 65536u

ec_bvh_build_node ec_node_of(const ec_range *range)
{
    ec_bvh_build_node node = {.first = range->first};
    for (int axis = 0; axis < 3; axis++) {
        node.lo[axis] = range->box.lo[axis];
        node.hi[axis] = range->box.hi[axis];
    }
    return node;
}

void ec_branch_number(ec_branch *branch, uint32_t slot, uint32_t *next)
{
    branch->slot = slot;
    branch->rest = *next;
    if (branch->nodes) {
        *next += branch->node_count - 1;
        return;
    }
    *next += 2;
    ec_branch_number(branch->child[0], branch->rest, next);
    ec_branch_number(branch->child[1], branch->rest + 1, next);
}

static void join_subtree(const ec_branch *branch, ec_bvh_build_node *nodes)
{
    for (uint32_t i = 0; i < branch->node_count; i++)
        if (branch->nodes[i].left) branch->nodes[i].left += branch->rest - 1;
    nodes[branch->slot] = branch->nodes[0];
    memcpy(nodes + branch->rest, branch->nodes + 1, (branch->node_count - 1) * sizeof *nodes);
}

void ec_branch_join(const ec_branch *branch, ec_bvh_build_node *nodes)
{
    if (branch->nodes) {
        join_subtree(branch, nodes);
        return;
    }
    nodes[branch->slot] = ec_node_of(&branch->range);
    nodes[branch->slot].first = branch->first;
    nodes[branch->slot].left = branch->rest;
    const ec_branch *right = branch->child[1];
#pragma omp task if (branch->range.count > TASK_TRIANGLES)
    ec_branch_join(right, nodes);
    ec_branch_join(branch->child[0], nodes);
}

void ec_branch_free(ec_branch *branch)
{
    if (!branch) return;
    ec_branch_free(branch->child[0]);
    ec_branch_free(branch->child[1]);
    free(branch->nodes);
    free(branch);
}
