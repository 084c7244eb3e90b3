/* Builds the binary tree: large ranges are split by all cores together, and triangles cut where that pays; small ranges become subtrees that one core
 * builds alone; the pieces are then joined in their order. */
#include <omp.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "accel/build_internal.h"
#include "base/clock.h"

#define SUBTREE 1024u /* references; not tied to the number of cores, since the numbering follows from it */
#define PARTS_SHARE 0.3     /* parts may exceed triangles by at most this share */
#define PARTS_LEAST 20u     /* if fewer than one triangle in so many is cut, it is not worth the boxes that every reference then needs */
#define REFS_MAX (1u << 27) /* limit of the binary layout's numbering; scenes that come near it are not cut */
#define LOAD_CHUNK 16384u
#define TEAM_MIN 4096u /* with fewer triangles the build is over before a second thread wakes */

static void fail(ec_builder *builder)
{
#pragma omp atomic write
    builder->failed = 1;
}

static void fill_leaf(const ec_builder *builder, const ec_range *range, uint32_t first)
{
    const ec_build_prim *prims = builder->prims[range->buffer] + range->first;
    for (uint32_t i = 0; i < range->count; i++) builder->order[first + i] = ec_prim_id(&prims[i]);
    for (uint32_t i = 0; builder->boxes && i < range->count; i++) {
        memcpy(builder->boxes[first + i].lo, &prims[i].lo, sizeof builder->boxes->lo);
        memcpy(builder->boxes[first + i].hi, &prims[i].hi, sizeof builder->boxes->hi);
    }
}

/* Fills tree->nodes[index] and all below it. */
static void build_subtree(ec_builder *builder, ec_branch *tree, uint32_t index, const ec_range *range)
{
    ec_range children[2];
    tree->nodes[index] = ec_node_of(range);
    tree->nodes[index].first = tree->first + (range->first - tree->range.first);
    if (!ec_range_split(builder, range, children)) {
        fill_leaf(builder, range, tree->nodes[index].first);
        tree->nodes[index].count = range->count;
        return;
    }
    uint32_t left = tree->node_count;
    if (!ec_reserve_lines(&tree->nodes, &tree->capacity, left, left + 2, sizeof *tree->nodes)) {
        fail(builder);
        return;
    }
    tree->node_count += 2;
    tree->nodes[index].left = left;
    build_subtree(builder, tree, left, &children[0]);
    build_subtree(builder, tree, left + 1, &children[1]);
}

/* Builds the tree over a range by tasks, down to the ranges that become subtrees; it is complete when all tasks have ended. */
static void build_branch(ec_builder *builder, const ec_range *range, ec_branch **result)
{
    ec_range children[2];
    ec_branch *tree = *result = calloc(1, sizeof *tree);
    if (!tree) {
        fail(builder);
        return;
    }
    tree->range = *range;
    if (range->count <= SUBTREE) {
        tree->range.capacity = range->count; /* no more cutting: finer parts gain little */
        return;
    }
    if (!ec_range_split(builder, range, children)) return; /* out of memory: the range is too long for a leaf */
    ec_range right = children[1];
    ec_branch **place = &tree->child[1];
#pragma omp task firstprivate(right, place)
    build_branch(builder, &right, place);
    build_branch(builder, &children[0], &tree->child[0]);
}

/* Gives every branch its place in the order; returns where it ends. */
static uint32_t place_branches(ec_branch *tree, uint32_t first)
{
    tree->first = first;
    if (!tree->child[0]) return first + tree->range.count;
    return place_branches(tree->child[1], place_branches(tree->child[0], first));
}

static void build_subtrees(ec_builder *builder, ec_branch *tree)
{
    if (tree->child[0]) {
        build_subtrees(builder, tree->child[0]);
        build_subtrees(builder, tree->child[1]);
        return;
    }
#pragma omp task
    {
        tree->node_count = 1;
        if (ec_reserve_lines(&tree->nodes, &tree->capacity, 0, 2 + tree->range.count / 2, sizeof *tree->nodes))
            build_subtree(builder, tree, 0, &tree->range);
        else
            fail(builder);
    }
}

static ec_range load(const ec_builder *builder, uint32_t count)
{
    ec_range root = {.count = count};
    ec_range_clear(&root);
    if (!count) return root; /* clang 14 would go through the loop below 2^32 times */
#pragma omp taskloop default(shared) grainsize(1)
    for (uint32_t first = 0; first < count; first += LOAD_CHUNK) {
        uint32_t left = count - first;
        ec_range part;
        ec_prims_load(builder->positions, builder->indices, first, left < LOAD_CHUNK ? left : LOAD_CHUNK,
                      builder->swept, builder->swept_count, builder->prims[0], &part);
#pragma omp critical(ec_accel_load)
        ec_range_join(&root, &part);
    }
    return root;
}

static void build_upper(ec_builder *builder, uint32_t count, uint32_t capacity, ec_branch **tree, uint32_t *ref_count)
{
    ec_range root = load(builder, count);
    root.capacity = capacity;
    builder->scene = root.box;
#pragma omp taskgroup
    build_branch(builder, &root, tree);
    if (!builder->failed) *ref_count = place_branches(*tree, 0);
}

static void build_all(ec_builder *builder, uint32_t count, uint32_t capacity, ec_branch **tree, uint32_t *ref_count)
{
    build_upper(builder, count, capacity, tree, ref_count);
    if (builder->failed) return;
    if (*ref_count > count && *ref_count - count < count / PARTS_LEAST) {
        ec_branch_free(*tree);
        build_upper(builder, count, count, tree, ref_count);
        if (builder->failed) return;
    }
    builder->order = malloc(((size_t)*ref_count + 1) * sizeof *builder->order);
    bool has_boxes = *ref_count > count || builder->swept_count;
    if (has_boxes) builder->boxes = malloc(*ref_count * sizeof *builder->boxes);
    if (!builder->order || (has_boxes && !builder->boxes)) {
        builder->failed = 1;
        return;
    }
#pragma omp taskgroup
    build_subtrees(builder, *tree);
}

static ec_branch *build_pieces(ec_builder *builder, uint32_t count, bool cut, int team, uint32_t *ref_count)
{
    ec_branch *tree = NULL;
    /* Memory for parts that are never cut is never touched. */
    uint32_t spare = cut && count < REFS_MAX ? REFS_MAX - count : 0, share = (uint32_t)(count * PARTS_SHARE);
    uint32_t capacity = count + (share < spare ? share : spare);
    for (int i = 0; i < 2; i++) builder->prims[i] = ec_allocate_lines(capacity, sizeof(ec_build_prim));
    if (builder->prims[0] && builder->prims[1]) {
#pragma omp parallel num_threads(team)
#pragma omp single
        build_all(builder, count, capacity, &tree, ref_count);
    } else {
        builder->failed = 1;
    }
    for (int i = 0; i < 2; i++) free(builder->prims[i]);
    return tree;
}

static ec_result build(ec_builder builder, uint32_t triangle_count, bool cut, uint32_t threads, ec_bvh *bvh, ec_bvh_stats *stats,
                       ec_error *err)
{
    double start = ec_now();
    int team = triangle_count < TEAM_MIN ? 1 : threads ? (int)threads : omp_get_max_threads();
    memset(bvh, 0, sizeof *bvh);
    if (triangle_count > INT32_MAX) return ec_fail(err, "%u triangles are more than a BVH can hold", triangle_count);
    ec_branch *tree = build_pieces(&builder, triangle_count, cut, team, &bvh->ref_count);
    if (!builder.failed) {
        bvh->node_count = 1;
        ec_branch_number(tree, 0, &bvh->node_count);
        bvh->nodes = malloc(bvh->node_count * sizeof *bvh->nodes);
    }
    bvh->triangle_count = triangle_count;
    bvh->leaf_most = builder.leaf_most;
    bvh->moving_count = builder.swept_count;
    bvh->order = builder.order;
    bvh->boxes = builder.boxes;
    if (bvh->nodes) {
#pragma omp parallel num_threads(team)
#pragma omp single
        ec_branch_join(tree, bvh->nodes);
        if (stats) ec_bvh_measure(bvh, ec_now() - start, stats);
    } else {
        ec_bvh_free(bvh);
    }
    ec_branch_free(tree);
    return bvh->nodes ? EC_OK : ec_fail(err, "out of memory for the BVH of %u triangles", triangle_count);
}

ec_result ec_bvh_build(const float *positions, const uint32_t *indices, uint32_t triangle_count, uint32_t threads,
                       ec_bvh *bvh, ec_bvh_stats *stats, ec_error *err)
{
    return build((ec_builder){.positions = positions, .indices = indices, .leaf_most = EC_LEAF_MAX}, triangle_count, true, threads, bvh, stats, err);
}

ec_result ec_bvh_build_whole(const float *positions, const uint32_t *indices, uint32_t triangle_count, const float *swept,
                             uint32_t swept_count, uint32_t threads, ec_bvh *bvh, ec_bvh_stats *stats, ec_error *err)
{
    const ec_builder builder = {.positions = positions, .indices = indices, .swept = swept, .swept_count = swept_count, .leaf_most = EC_LEAF_MAX};
    return build(builder, triangle_count, false, threads, bvh, stats, err);
}

ec_result ec_bvh_build_boxes(const ec_box *boxes, uint32_t count, uint32_t threads, ec_bvh *bvh, ec_error *err)
{
    return build((ec_builder){.swept = boxes->lo, .swept_count = count, .leaf_most = 1}, count, false, threads, bvh, NULL, err);
}

void ec_bvh_free(ec_bvh *bvh)
{
    if (!bvh) return;
    free(bvh->nodes);
    free(bvh->order);
    free(bvh->boxes);
    memset(bvh, 0, sizeof *bvh);
}
