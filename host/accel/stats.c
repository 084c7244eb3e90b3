/* Figures that tell a good tree from a bad one. */
#include "accel/build_internal.h"
#include "accel/leaf.h"

static double half_area(const ec_bvh_build_node *node) { return ec_box_half_area(node->lo, node->hi); }

/* Adds the subtree's share of the SAH cost (MacDonald and Booth 1990) times the root's area. */
static void visit(const ec_bvh *bvh, uint32_t index, uint32_t depth, ec_bvh_stats *stats)
{
    const ec_bvh_build_node *node = &bvh->nodes[index];
    if (depth > stats->max_depth) stats->max_depth = depth;
    if (!node->left) {
        stats->leaf_count++;
        stats->sah_cost += EC_COST_BLOCK * half_area(node);
        return;
    }
    stats->sah_cost += EC_COST_NODE * half_area(node);
    visit(bvh, node->left, depth + 1, stats);
    visit(bvh, node->left + 1, depth + 1, stats);
}

void ec_bvh_measure(const ec_bvh *bvh, double build_seconds, ec_bvh_stats *stats)
{
    *stats = (ec_bvh_stats){.build_seconds = build_seconds, .node_count = bvh->node_count,
                             .ref_count = bvh->ref_count};
    if (bvh->triangle_count) visit(bvh, 0, 0, stats);
    else stats->leaf_count = 1;
    double root = bvh->triangle_count ? half_area(&bvh->nodes[0]) : 0.0;
    stats->sah_cost = root > 0.0 ? stats->sah_cost / root : 0.0;
    stats->leaf_fill = bvh->ref_count / ((double)EC_LEAF_MAX * stats->leaf_count);
}
