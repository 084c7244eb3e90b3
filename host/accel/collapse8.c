/* Finds the cheapest way to make 8-wide nodes of a binary tree, by dynamic programming from the leaves up: Ylitie, Karras and Laine 2017, "Efficient
 * incoherent ray traversal on GPUs through compressed wide BVHs", section 3. */
#include <stdlib.h>

#include "accel/layout_internal.h"

#define COST_WIDE_NODE 1.0f
#define COST_WIDE_BLOCK 1.0f
#define TASK_DEPTH 8 /* 256 tasks at most */
#define TEAM_MIN 1024 /* nodes */

/* cost[j - 1]: of a subtree that may become up to j children of the node above it. */
typedef struct slot_costs {
    float cost[7];
} slot_costs;

typedef struct dp {
    const ec_bvh *bvh;
    const ec_subtree *subtrees;
    uint8_t (*slots)[9];
    float scale;
} dp;

static float half_area(const ec_bvh_build_node *node, float scale)
{
    float x = (node->hi[0] - node->lo[0]) * scale, y = (node->hi[1] - node->lo[1]) * scale;
    float z = (node->hi[2] - node->lo[2]) * scale;
    return x * y + (x + y) * z;
}

/* Finds the cheapest way to divide `slots` children between left and right. Even shares win ties: they keep trees flat. */
static float distribute(const slot_costs *left, const slot_costs *right, int slots, uint8_t *share)
{
    int best = slots / 2;
    float cost = left->cost[best - 1] + right->cost[slots - best - 1];
    for (int k = 1; k < slots; k++) {
        float other = left->cost[k - 1] + right->cost[slots - k - 1];
        if (!(other < cost)) continue;
        cost = other;
        best = k;
    }
    *share = (uint8_t)best;
    return cost;
}

static void solve(const dp *d, uint32_t index, int depth, slot_costs *costs)
{
    const ec_bvh_build_node *node = &d->bvh->nodes[index];
    uint8_t *slots = d->slots[index];
    float area = half_area(node, d->scale), leaf = COST_WIDE_BLOCK * area;
    if (!node->left) {
        for (int j = 1; j <= 8; j++) slots[j] = 0;
        for (int j = 1; j < 8; j++) costs->cost[j - 1] = leaf;
        return;
    }
    slot_costs left, right;
    if (depth < TASK_DEPTH) {
#pragma omp task shared(left)
        solve(d, node->left, depth + 1, &left);
        solve(d, node->left + 1, depth + 1, &right);
#pragma omp taskwait
    } else {
        solve(d, node->left, depth + 1, &left);
        solve(d, node->left + 1, depth + 1, &right);
    }
    float inner = distribute(&left, &right, 8, &slots[8]) + COST_WIDE_NODE * area;
    slots[1] = d->subtrees[index].count > d->bvh->leaf_most || inner < leaf;
    costs->cost[0] = slots[1] ? inner : leaf;
    for (int j = 2; j < 8; j++) {
        costs->cost[j - 1] = distribute(&left, &right, j, &slots[j]);
        if (costs->cost[j - 1] < costs->cost[j - 2]) continue;
        costs->cost[j - 1] = costs->cost[j - 2];
        slots[j] = 0;
    }
}

int ec_collapse8(const ec_bvh *bvh, const ec_subtree *subtrees, ec_collapse *collapse)
{
    collapse->slots = malloc(bvh->node_count * sizeof *collapse->slots);
    if (!collapse->slots) return 0;
    const ec_bvh_build_node *root = &bvh->nodes[0];
    float longest = 0.0f;
    for (int axis = 0; axis < 3; axis++) {
        float extent = root->hi[axis] - root->lo[axis];
        if (extent > longest) longest = extent;
    }
    dp d = {.bvh = bvh, .subtrees = subtrees, .slots = collapse->slots, .scale = 1.0f / longest};
    slot_costs costs;
#pragma omp parallel if (bvh->node_count > TEAM_MIN)
#pragma omp single
    solve(&d, 0, 0, &costs);
    return 1;
}
