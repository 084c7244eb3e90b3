/* One good binary BVH, built once, and the layouts derived from it for the kernels. Knows nothing of OpenCL. */
#ifndef EC_ACCEL_BVH_H
#define EC_ACCEL_BVH_H

#include <stdint.h>

#include "base/error.h"
#include "shared/accel.h" /* nodes, triangles, boxes: kernels/shared */

typedef struct ec_bvh_build_node {
    float lo[3], hi[3];
    uint32_t left;         /* inner: index of the left child, behind its parent; the right one is left + 1; leaf: 0 */
    uint32_t first, count; /* leaf when count > 0: order[first .. first + count); first is set in inner nodes too */
} ec_bvh_build_node;

typedef struct ec_bvh {
    uint32_t node_count;
    ec_bvh_build_node *nodes;  /* nodes[0] is the root; owned */
    uint32_t triangle_count;
    uint32_t ref_count;        /* references in the leaves: triangles, of which some may have been cut into several parts */
    uint32_t leaf_most;        /* references that a leaf may hold: 8, or 1 in trees of instances */
    uint32_t moving_count;     /* the first so many triangles move, and are known only by the boxes of their references */
    uint32_t *order;           /* triangle ids of the references in leaf order; owned */
    ec_box *boxes;             /* of the references; NULL if none was cut and none moves: each has its triangle's box then; owned */
} ec_bvh;

typedef struct ec_bvh_stats {
    double build_seconds;
    double sah_cost;           /* of the binary tree, in units of one node visit */
    uint32_t node_count, leaf_count, max_depth;
    uint32_t ref_count;        /* as in ec_bvh */
    double leaf_fill;          /* references / slots of the 8-wide leaf blocks */
} ec_bvh_stats;

/* Builds the tree by binned SAH (Wald 2007) on all cores; leaves hold at most 8 triangles and are charged by the block of 8. In the upper tree,
 * triangles may be cut along a plane (Stich et al. 2009), each part a reference with a box of its own; all boxes of a triangle's references together
 * hold it. positions: 3 floats a vertex; indices: 3 a triangle. The result is the same for any thread count.
 * threads 0 = all. Also correct for 0 triangles (one empty leaf) and for any number of coincident ones (no recursion
 * deeper than 64 + log2 n, no quadratic time). */
ec_result ec_bvh_build(const float *positions, const uint32_t *indices, uint32_t triangle_count, uint32_t threads,
                       ec_bvh *bvh, ec_bvh_stats *stats, ec_error *err);
/* Likewise, without cutting triangles. swept: the first of them move, and are sorted by boxes of their own, 6 floats each; if there are any,
 * bvh->boxes is never NULL. */
ec_result ec_bvh_build_whole(const float *positions, const uint32_t *indices, uint32_t triangle_count, const float *swept,
                             uint32_t swept_count, uint32_t threads, ec_bvh *bvh, ec_bvh_stats *stats, ec_error *err);
void ec_bvh_free(ec_bvh *bvh);

/* Layouts; arrays are malloc'ed and the caller's. boxes: one for each triangle or block; NULL if bvh->boxes is. */
typedef struct ec_bvh2 {
    ec_bvh2_node *nodes;
    ec_tri *triangles;
    ec_box *boxes;
    uint32_t node_count, triangle_count;
} ec_bvh2;
/* Makes the binary layout. Leaves are split further: SAH per triangle, leaves of <= 4. */
ec_result ec_bvh2_layout(const ec_bvh *bvh, const float *positions, const uint32_t *indices, ec_bvh2 *layout, ec_error *err);

typedef struct ec_bvh8 {
    ec_bvh8_node *nodes;
    ec_tri8 *blocks;
    ec_box8 *boxes;
    uint32_t node_count, block_count;
} ec_bvh8;
ec_result ec_bvh8_layout(const ec_bvh *bvh, const float *positions, const uint32_t *indices, ec_bvh8 *layout, ec_error *err);

#endif
