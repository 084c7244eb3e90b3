/* Types that the steps of the kd-tree's builder pass to each other. Private to host/accel. */
#ifndef EC_ACCEL_KD_INTERNAL_H
#define EC_ACCEL_KD_INTERNAL_H

#include "accel/accel_internal.h"

/* Cost of a block, in visits to an inner node: what a block of eight costs a ray with PoCL on a CPU (measured with bench_traversal). */
#define EC_KD_COST_BLOCK 2.0f
#define EC_KD_EMPTY 0.8f /* a split that cuts off empty space is worth this much more than its cost says */

/* A reference within a cell: its box cut to the cell. */
typedef struct ec_kd_item {
    ec_box box;
    uint32_t ref;
} ec_kd_item;

/* A node of the binary tree. Inner: children at `index` and index + 1 (below and above the plane); leaf, axis EC_KD_NO_PLANE: `index`
 * blocks from `first` on. */
typedef struct ec_kd_binary {
    float plane;
    uint32_t first, axis, index;
} ec_kd_binary;

/* kd_collapse.c: makes the layout of the kernels. Malloc'ed, the caller's; NULL when out of memory. */
ec_kd_node *ec_kd_collapse(const ec_kd_binary *tree, uint32_t *node_count);

typedef struct ec_kd_split {
    float cost;      /* of the cell when split, in visits; INFINITY: no plane divides it */
    float plane;
    int axis;
    int flat_left;   /* items that lie in the plane go below it, else above */
    uint32_t left, right;
} ec_kd_split;

/* kd_split.c: finds the cheapest plane by the surface area heuristic. Up to EC_KD_EXACT items, every side of a box is weighed; beyond that, planes at
 * equal steps (Wald and Havran 2006; Shevtsov et al. 2007). */
#define EC_KD_EXACT 64u
ec_kd_split ec_kd_choose(const ec_kd_item *items, uint32_t count, const ec_box *cell);
float ec_kd_leaf_cost(uint32_t count);

/* Returns the sides on which an item is needed: bit 0 below, bit 1 above. Boxes that end at the plane are not needed behind it. */
static inline int ec_kd_sides(const ec_kd_item *item, const ec_kd_split *s)
{
    float lo = item->box.lo[s->axis], hi = item->box.hi[s->axis];
    if (lo == s->plane && hi == s->plane) return s->flat_left ? 1 : 2;
    return (lo < s->plane ? 1 : 0) | (hi > s->plane ? 2 : 0);
}

#endif
