/* What the steps of the builder pass to each other. Private to host/accel. */
#ifndef EC_ACCEL_BUILD_INTERNAL_H
#define EC_ACCEL_BUILD_INTERNAL_H

#include <stddef.h>

#include "accel/bvh.h"
#include "accel/vec4.h"

/* Costs in units of one visit to a binary node. A leaf is tested by the block of eight triangles, however few it holds,
 * and a block costs what the traversal sketch measured: two visits. */
#define EC_COST_NODE 1.0f
#define EC_COST_BLOCK 2.0f
#define EC_LEAF_MAX 8u
#define EC_DEPTH_MAX 63u /* edges from the root to the deepest leaf */
#define EC_BINS 16

/* A triangle on its way down the tree, moved rather than pointed to, so that every pass streams through memory. */
typedef struct ec_prim {
    ec_v4 lo; /* lane 3: the bits of the triangle's index */
    ec_v4 hi; /* lane 3: 0 */
} ec_prim;

/* A node to be: prims[buffer][first .. first + count). */
typedef struct ec_range {
    ec_box4 box;       /* of the triangles */
    ec_box4 centroids; /* of their box centres, doubled */
    uint32_t first, count, depth;
    uint32_t buffer;
} ec_range;

/* Equal-width bins along all three axes: bin = min((centroid - origin) * scale, last). */
typedef struct ec_binning {
    ec_v4 origin, scale, last;
} ec_binning;

typedef struct ec_bins {
    ec_box4 box[EC_BINS][3];
    ec_i4 count[EC_BINS]; /* one lane an axis */
} ec_bins;

typedef struct ec_split {
    float cost;          /* of the two children as leaves: blocks times half areas, edges scaled as in bins.c */
    float leaf_cost;     /* of the parent as a leaf, likewise; NaN for boxes that have no finite area */
    float node_cost;     /* of visiting the parent, to be added to cost */
    int axis;            /* -1: nothing to split, or costs that are not numbers */
    int bin;             /* first bin of the right side */
    uint32_t left_count;
    ec_box4 left, right;
} ec_split;

/* Reading and moving: prim.c */
static inline ec_v4 ec_prim_lo(const ec_prim *prim)
{
    /* Triangle indices look like denormal floats, which some processors add a hundred times slower. */
    return (ec_v4)((ec_i4)prim->lo & (ec_i4){-1, -1, -1, 0});
}
static inline uint32_t ec_prim_id(const ec_prim *prim) { return (uint32_t)((ec_i4)prim->lo)[3]; }
static inline ec_i4 ec_bin_of(const ec_binning *binning, ec_v4 centroid)
{
    return ec_v4_truncate(ec_v4_min((centroid - binning->origin) * binning->scale, binning->last));
}

void ec_prims_load(const float *positions, const uint32_t *indices, uint32_t first, uint32_t count, ec_prim *prims,
                   ec_range *bounds);
void ec_prims_bound(const ec_prim *prims, uint32_t count, ec_range *bounds);
/* Copies prims to *left or *right, which move on, in their order; grows the centroid boxes of the sides. */
void ec_prims_partition(const ec_prim *prims, uint32_t count, const ec_binning *binning, const ec_split *split,
                        ec_prim *left, ec_prim *right, ec_box4 centroids[2]);

/* bins.c */
ec_binning ec_binning_of(const ec_range *range);
void ec_bins_fill(ec_bins *bins, const ec_binning *binning, const ec_prim *prims, uint32_t count);
void ec_bins_merge(ec_bins *bins, const ec_bins *more);
uint32_t ec_bins_left(const ec_bins *bins, const ec_split *split);
ec_split ec_bins_split(const ec_bins *bins, const ec_range *range);

/* split.c: divides a range in two, in parallel when it is long. False when it should be a leaf. */
typedef struct ec_builder {
    ec_prim *prims[2];
    uint32_t *order;
    int failed; /* out of memory somewhere; written atomically */
} ec_builder;
int ec_range_split(ec_builder *builder, const ec_range *range, ec_range children[2]);

/* branch.c: a node of the upper tree is two children, or a subtree whose nodes[0] is its root and whose nodes number
 * their children within it. */
typedef struct ec_branch {
    ec_range range;
    struct ec_branch *child[2];
    ec_bvh_build_node *nodes; /* owned; NULL where there are children */
    uint32_t node_count, capacity;
    uint32_t slot; /* place in the joined tree */
    uint32_t rest; /* there: of the children, or of nodes[1] */
} ec_branch;
ec_bvh_build_node ec_node_of(const ec_range *range); /* inner until told otherwise */
int ec_branch_reserve(ec_branch *branch, uint32_t count);
/* Gives every node its place, children side by side and subtrees whole; *next: the first free place. */
void ec_branch_number(ec_branch *branch, uint32_t slot, uint32_t *next);
void ec_branch_join(const ec_branch *branch, ec_bvh_build_node *nodes);
void ec_branch_free(ec_branch *branch);

/* tree.c: cache-line aligned memory for at least one element, for free(). */
void *ec_allocate_lines(size_t count, size_t size);

/* stats.c: everything but the time is read off the tree. */
void ec_bvh_measure(const ec_bvh *bvh, double build_seconds, ec_bvh_stats *stats);

/* Whether a subtree of count triangles whose root lies at depth can still be halved down to single triangles. */
static inline int ec_depth_allows(uint32_t depth, uint32_t count)
{
    uint32_t levels = 0;
    while (levels < 32 && count > (uint32_t)(1ull << levels)) levels++;
    return depth + levels <= EC_DEPTH_MAX;
}

#endif
