/* Decides which child a shadow ray should enter first: the one with the best chance of a hit for what it costs. Nothing is known of what is below but
 * boxes, and these suffice: with true chances in the leaves the order hardly differs. In the spirit of Nah and Manocha 2014, "SATO: surface area
 * traversal order for shadow ray tracing". */
#include "accel/layout_internal.h"
#include "base/freed.h"

#define LEAF_CHANCE 0.5f
#define NODE_COST 0.4f /* in leaves */

typedef struct hit_cost {
    float chance, cost; /* chance of a hit below a node that the ray enters, and the cost of what it visits until then */
} hit_cost;

static float half_area(const ec_bvh_build_node *n)
{
    float x = n->hi[0] - n->lo[0], y = n->hi[1] - n->lo[1], z = n->hi[2] - n->lo[2];
    return x * y + y * z + z * x;
}

/* A random ray through a box enters a box inside it with the probability of their areas' ratio. */
static hit_cost hit_cost_of(const ec_bvh *bvh, const hit_cost *below, const ec_bvh_build_node *node)
{
    uint32_t first = node->left, second = node->left + 1;
    if (below[second].chance * below[first].cost > below[first].chance * below[second].cost) {
        first = node->left + 1;
        second = node->left;
    }
    float area = half_area(node);
    float enter_first = half_area(&bvh->nodes[first]) / area, enter_second = half_area(&bvh->nodes[second]) / area;
    float open = 1.0f - enter_first * below[first].chance;
    return (hit_cost){1.0f - open * (1.0f - enter_second * below[second].chance),
                     NODE_COST + enter_first * below[first].cost + open * enter_second * below[second].cost};
}

float *ec_bvh_promises(const ec_bvh *bvh)
{
    EC_FREED hit_cost *below = malloc(bvh->node_count * sizeof *below);
    float *promises = malloc(bvh->node_count * sizeof *promises);
    for (uint32_t i = below && promises ? bvh->node_count : 0; i-- > 0;) { /* children lie behind their parents */
        const ec_bvh_build_node *node = &bvh->nodes[i];
        below[i] = node->left ? hit_cost_of(bvh, below, node) : (hit_cost){LEAF_CHANCE, 1.0f};
        promises[i] = below[i].chance / below[i].cost;
    }
    if (!below) free(promises);
    return below ? promises : NULL;
}
