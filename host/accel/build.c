/* The binary tree: large ranges are split by all cores together, small ones become subtrees that one core builds alone,
 * and the pieces are then joined in their order. */
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "accel/build_internal.h"
#include "base/clock.h"

#define SUBTREE 4096u /* triangles; not tied to the number of cores, since the numbering follows from it */
#define LOAD_CHUNK 16384u
#define TEAM_MIN 4096u /* fewer triangles are built sooner than a second thread wakes */

static void fail(ec_builder *builder)
{
#pragma omp atomic write
    builder->failed = 1;
}

/* Fills tree->nodes[index] and all below it. */
static void build_subtree(ec_builder *builder, ec_branch *tree, uint32_t index, const ec_range *range)
{
    ec_range children[2];
    tree->nodes[index] = ec_node_of(range);
    if (!ec_range_split(builder, range, children)) {
        const ec_prim *prims = builder->prims[range->buffer] + range->first;
        for (uint32_t i = 0; i < range->count; i++) builder->order[range->first + i] = ec_prim_id(&prims[i]);
        tree->nodes[index].count = range->count;
        return;
    }
    uint32_t left = tree->node_count;
    if (!ec_branch_reserve(tree, left + 2)) {
        fail(builder);
        return;
    }
    tree->node_count += 2;
    tree->nodes[index].left = left;
    build_subtree(builder, tree, left, &children[0]);
    build_subtree(builder, tree, left + 1, &children[1]);
}

/* The tree over a range, by tasks; whole when all of them have ended. */
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
        tree->node_count = 1;
        if (ec_branch_reserve(tree, 1 + range->count / 4))
            build_subtree(builder, tree, 0, range);
        else
            fail(builder);
        return;
    }
    if (!ec_range_split(builder, range, children)) return; /* out of memory: the range is too long for a leaf */
    ec_range right = children[1];
    ec_branch **place = &tree->child[1];
#pragma omp task firstprivate(right, place)
    build_branch(builder, &right, place);
    build_branch(builder, &children[0], &tree->child[0]);
}

static ec_range load(ec_builder *builder, const float *positions, const uint32_t *indices, uint32_t count)
{
    ec_range root = {.box = ec_box4_empty(), .centroids = ec_box4_empty(), .count = count};
#pragma omp taskloop default(shared) grainsize(1)
    for (uint32_t first = 0; first < count; first += LOAD_CHUNK) {
        uint32_t left = count - first;
        ec_range part;
        ec_prims_load(positions, indices, first, left < LOAD_CHUNK ? left : LOAD_CHUNK, builder->prims[0], &part);
#pragma omp critical(ec_accel_load)
        {
            ec_box4_grow(&root.box, part.box.lo, part.box.hi);
            ec_box4_grow(&root.centroids, part.centroids.lo, part.centroids.hi);
        }
    }
    return root;
}

static void build_all(ec_builder *builder, const float *positions, const uint32_t *indices, uint32_t count,
                      ec_branch **tree)
{
    ec_range root = load(builder, positions, indices, count);
#pragma omp taskgroup
    build_branch(builder, &root, tree);
}

static ec_branch *build_pieces(ec_builder *builder, const float *positions, const uint32_t *indices, uint32_t count,
                               int team)
{
    ec_branch *tree = NULL;
    builder->order = malloc(((size_t)count + 1) * sizeof *builder->order);
    for (int i = 0; i < 2; i++) builder->prims[i] = ec_allocate_lines(count, sizeof(ec_prim));
    if (builder->order && builder->prims[0] && builder->prims[1]) {
#pragma omp parallel num_threads(team)
#pragma omp single
        build_all(builder, positions, indices, count, &tree);
    } else {
        builder->failed = 1;
    }
    for (int i = 0; i < 2; i++) free(builder->prims[i]);
    return tree;
}

ec_result ec_bvh_build(const float *positions, const uint32_t *indices, uint32_t triangle_count, uint32_t threads,
                       ec_bvh *bvh, ec_bvh_stats *stats, ec_error *err)
{
    double start = ec_now();
    int team = triangle_count < TEAM_MIN ? 1 : threads ? (int)threads : omp_get_max_threads();
    memset(bvh, 0, sizeof *bvh);
    if (triangle_count > INT32_MAX) return ec_fail(err, "%u triangles are more than a BVH can hold", triangle_count);
    ec_builder builder = {0};
    ec_branch *tree = build_pieces(&builder, positions, indices, triangle_count, team);
    if (!builder.failed) {
        bvh->node_count = 1;
        ec_branch_number(tree, 0, &bvh->node_count);
        bvh->nodes = malloc(bvh->node_count * sizeof *bvh->nodes);
    }
    if (bvh->nodes) {
#pragma omp parallel num_threads(team)
#pragma omp single
        ec_branch_join(tree, bvh->nodes);
        bvh->triangle_count = triangle_count;
        bvh->order = builder.order;
    } else {
        free(builder.order);
    }
    ec_branch_free(tree);
    if (!bvh->nodes) return ec_fail(err, "out of memory for the BVH of %u triangles", triangle_count);
    if (stats) ec_bvh_measure(bvh, ec_now() - start, stats);
    return EC_OK;
}

void ec_bvh_free(ec_bvh *bvh)
{
    if (!bvh) return;
    free(bvh->nodes);
    free(bvh->order);
    memset(bvh, 0, sizeof *bvh);
}
