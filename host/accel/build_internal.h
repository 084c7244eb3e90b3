/* Types that the steps of the builder pass to each other. Private to host/accel. */
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

/* A triangle, or what planes have left of one, on its way down the tree; moved rather than pointed to, so that every pass
 * streams through memory. */
typedef struct ec_build_prim {
    ec_v4 lo; /* lane 3: the bits of the triangle's index */
    ec_v4 hi; /* lane 3: 0 */
} ec_build_prim;

/* A future node: prims[buffer][first .. first + count). */
typedef struct ec_range {
    ec_box4 box;       /* of the triangles */
    ec_box4 centroids; /* of their box centres, doubled */
    ec_v4 longest;     /* of their boxes' edges along each axis */
    uint32_t first, count, depth;
    uint32_t capacity; /* places from first on; those past count are for the parts of triangles that will be cut */
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
    uint32_t left_count, right_count;
    ec_box4 left, right;
} ec_split;

/* Adds up the bounds of ranges, from those of their parts. */
static inline void ec_range_clear(ec_range *range)
{
    range->box = range->centroids = ec_box4_empty();
    range->longest = ec_v4_all(0.0f);
}
static inline void ec_range_add(ec_range *range, ec_v4 lo, ec_v4 hi)
{
    ec_v4 centroid = lo + hi;
    ec_box4_grow(&range->centroids, centroid, centroid);
    range->longest = ec_v4_max(hi - lo, range->longest);
}
static inline void ec_range_join(ec_range *range, const ec_range *part)
{
    ec_box4_grow(&range->box, part->box.lo, part->box.hi);
    ec_box4_grow(&range->centroids, part->centroids.lo, part->centroids.hi);
    range->longest = ec_v4_max(part->longest, range->longest);
}

/* Reading and moving: prim.c */
static inline ec_v4 ec_prim_lo(const ec_build_prim *prim)
{
    /* Triangle indices look like denormal floats, which some processors add a hundred times slower. */
    return (ec_v4)((ec_i4)prim->lo & (ec_i4){-1, -1, -1, 0});
}
static inline uint32_t ec_prim_id(const ec_build_prim *prim) { return (uint32_t)((ec_i4)prim->lo)[3]; }
static inline ec_build_prim ec_prim_of(const ec_box4 *box, uint32_t id)
{
    const ec_i4 xyz = {-1, -1, -1, 0};
    return (ec_build_prim){(ec_v4)(((ec_i4)box->lo & xyz) | (ec_i4){0, 0, 0, (int32_t)id}), (ec_v4)((ec_i4)box->hi & xyz)};
}
static inline ec_i4 ec_bin_of(const ec_binning *binning, ec_v4 centroid)
{
    return ec_v4_truncate(ec_v4_min((centroid - binning->origin) * binning->scale, binning->last));
}

void ec_prims_load(const float *positions, const uint32_t *indices, uint32_t first, uint32_t count, const float *swept,
                   uint32_t swept_count, ec_build_prim *prims, ec_range *bounds);
void ec_prims_bound(const ec_build_prim *prims, uint32_t count, ec_range *bounds);
/* Sets the children's places; the places left over are divided between them, `slack` of these for the left one. */
void ec_range_place(const ec_range *range, uint32_t left_count, uint32_t right_count, uint32_t slack, uint32_t buffer,
                    ec_range children[2]);
void ec_prim_vertices(const float *positions, const uint32_t *indices, uint32_t id, ec_v4 vertices[3]);
/* Copies prims to *left or *right, which advance, in their order; bounds the sides, except for their boxes. */
void ec_prims_partition(const ec_build_prim *prims, uint32_t count, const ec_binning *binning, const ec_split *split,
                        ec_build_prim *left, ec_build_prim *right, ec_range sides[2]);

/* bins.c */
ec_binning ec_binning_of(const ec_range *range);
void ec_bins_fill(ec_bins *bins, const ec_binning *binning, const ec_build_prim *prims, uint32_t count);
void ec_bins_merge(ec_bins *bins, const ec_bins *more);
uint32_t ec_bins_left(const ec_bins *bins, const ec_split *split);
/* ends: like bins->count, but for the last bins that triangles reach into. */
ec_split ec_bins_split(const ec_bins *bins, const ec_i4 ends[EC_BINS], const ec_range *range);

/* Long ranges are processed chunk by chunk on all cores; the chunks are the same for any number of cores, and so is every result. */
#define EC_CHUNK 16384u
static inline uint32_t ec_chunk_count(const ec_range *range)
{
    return range->count < 4 * EC_CHUNK ? 1 : (range->count + EC_CHUNK - 1) / EC_CHUNK;
}
static inline uint32_t ec_chunk_length(const ec_range *range, uint32_t index)
{
    return index + 1 < ec_chunk_count(range) ? EC_CHUNK : range->count - index * EC_CHUNK;
}

/* split.c: divides a range in two, in parallel if it is long. Returns false if it should be a leaf. */
typedef struct ec_builder {
    const float *positions;
    const uint32_t *indices;
    const float *swept; /* 6 floats each of the first triangles: their boxes, in place of their vertices' */
    uint32_t swept_count;
    uint32_t leaf_most; /* most references of a leaf */
    ec_build_prim *prims[2];
    uint32_t *order;
    ec_box *boxes; /* NULL until triangles have been cut, unless some move */
    ec_box4 scene; /* the box of all triangles */
    int failed;    /* out of memory somewhere; written atomically */
} ec_builder;
int ec_range_split(ec_builder *builder, const ec_range *range, ec_range children[2]);

/* cut.c: splits a range by a plane that cuts triangles, where there are places for the parts and that is cheaper than
 * `objects`, the best split of whole ones. */
int ec_range_cut(ec_builder *builder, const ec_range *range, const ec_split *objects, ec_range children[2]);

/* Computes the parts of a triangle on both sides of a plane, as far as they lie in `box`: bounds of each, never too small, and larger than the exact
 * ones by at most 8 FLT_EPSILON (|a| + |b|), where the plane cuts an edge from a to b. Empty: lo > hi. */
void ec_triangle_cut(const ec_v4 vertices[3], const ec_box4 *box, int axis, float at, ec_box4 part[2]);

/* branch.c: a node of the upper tree is two children, or a subtree whose nodes[0] is its root and whose nodes number
 * their children within it. */
typedef struct ec_branch {
    ec_range range;
    struct ec_branch *child[2];
    ec_bvh_build_node *nodes; /* owned; NULL where there are children */
    uint32_t node_count, capacity;
    uint32_t first; /* of its references in the order */
    uint32_t slot;  /* place in the joined tree */
    uint32_t rest;  /* place in the joined tree of the children, or of nodes[1] */
} ec_branch;
ec_bvh_build_node ec_node_of(const ec_range *range); /* an inner node unless changed */
/* Gives every node its place, children next to each other and subtrees in one piece; *next: the first free place. */
void ec_branch_number(ec_branch *branch, uint32_t slot, uint32_t *next);
void ec_branch_join(const ec_branch *branch, ec_bvh_build_node *nodes);
void ec_branch_free(ec_branch *branch);

/* tree.c */
/* Allocates memory for at least one element, of the kind that a processor may use in place (base/memory.h); to be freed with free(). */
void *ec_allocate_lines(size_t count, size_t size);

/* Makes room for `wanted` elements in such memory, at least doubling it; the first `used` stay. array: the address of a pointer of some type. Returns
 * false if it is out of memory; nothing has changed then. */
int ec_reserve_lines(void *array, uint32_t *room, uint32_t used, uint64_t wanted, size_t size);

/* layout8.c: makes wide nodes over boxes [0 .. count), whose leaves are one box each: EC_LEAF_BIT | EC_INSTANCE_BIT | box + 1. No blocks. */
ec_result ec_bvh8_of_boxes(const ec_box *boxes, uint32_t count, uint32_t threads, ec_bvh8 *layout, ec_error *err);
/* bvh_build.c: builds the tree that they are made of. */
ec_result ec_bvh_build_boxes(const ec_box *boxes, uint32_t count, uint32_t threads, ec_bvh *bvh, ec_error *err);

/* stats.c: reads everything but the time off the tree. */
void ec_bvh_measure(const ec_bvh *bvh, double build_seconds, ec_bvh_stats *stats);

/* Returns whether a subtree of count triangles whose root lies at depth can still be halved down to single triangles. */
static inline int ec_depth_allows(uint32_t depth, uint32_t count)
{
    uint32_t levels = 0;
    while (levels < 32 && count > (uint32_t)(1ull << levels)) levels++;
    return depth + levels <= EC_DEPTH_MAX;
}

#endif
