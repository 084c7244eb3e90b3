/* The binary tree: large ranges are split by all cores together, small ones become subtrees that one core builds alone,
 * and the pieces are then joined in their order. */
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "accel/build_internal.h"
#include "base/clock.h"

#define SUBTREE 4096u  /* triangles; not tied to the number of cores, since the numbering follows from it */
#define LOAD_CHUNK 16384u

/* A node of the upper tree: two children, or a subtree whose nodes[0] is its root. */
typedef struct branch {
    ec_range range;
    struct branch *child[2];
    ec_bvh_build_node *nodes;
    uint32_t node_count, capacity;
    uint32_t slot;   /* place in the joined tree */
    uint32_t rest;   /* there: of the children, or of nodes[1] */
} branch;

static void fail(ec_builder *builder)
{
#pragma omp atomic write
    builder->failed = 1;
}

static ec_bvh_build_node node_of(const ec_range *range)
{
    ec_bvh_build_node node = {.left = 0, .first = range->first, .count = 0};
    for (int axis = 0; axis < 3; axis++) {
        node.lo[axis] = range->box.lo[axis];
        node.hi[axis] = range->box.hi[axis];
    }
    return node;
}

static int reserve(branch *tree, uint32_t count)
{
    if (count <= tree->capacity) return 1;
    uint32_t capacity = 2 * count;
    ec_bvh_build_node *nodes = realloc(tree->nodes, capacity * sizeof *nodes);
    if (!nodes) return 0;
    tree->nodes = nodes;
    tree->capacity = capacity;
    return 1;
}

/* Fills tree->nodes[index] and all below it. */
static void build_subtree(ec_builder *builder, branch *tree, uint32_t index, const ec_range *range)
{
    ec_range children[2];
    tree->nodes[index] = node_of(range);
    if (!ec_range_split(builder, range, children)) {
        const ec_prim *prims = builder->prims[range->buffer] + range->first;
        for (uint32_t i = 0; i < range->count; i++) builder->order[range->first + i] = ec_prim_id(&prims[i]);
        tree->nodes[index].count = range->count;
        return;
    }
    uint32_t left = tree->node_count;
    if (!reserve(tree, left + 2)) {
        fail(builder);
        return;
    }
    tree->node_count += 2;
    tree->nodes[index].left = left;
    build_subtree(builder, tree, left, &children[0]);
    build_subtree(builder, tree, left + 1, &children[1]);
}

static void build_branch(ec_builder *builder, const ec_range *range, branch **result)
{
    ec_range children[2];
    branch *tree = *result = calloc(1, sizeof *tree);
    if (!tree) {
        fail(builder);
        return;
    }
    tree->range = *range;
    if (range->count <= SUBTREE) {
        tree->node_count = 1;
        if (reserve(tree, 1 + range->count / 4))
            build_subtree(builder, tree, 0, range);
        else
            fail(builder);
        return;
    }
    if (!ec_range_split(builder, range, children)) return; /* out of memory: the range is too long for a leaf */
    ec_range right = children[1];
    branch **place = &tree->child[1];
#pragma omp task firstprivate(right, place)
    build_branch(builder, &right, place);
    build_branch(builder, &children[0], &tree->child[0]);
}

/* Numbers the joined nodes, children side by side and subtrees whole. */
static void number_branch(branch *tree, uint32_t slot, uint32_t *next)
{
    tree->slot = slot;
    tree->rest = *next;
    if (tree->nodes) {
        *next += tree->node_count - 1;
        return;
    }
    *next += 2;
    number_branch(tree->child[0], tree->rest, next);
    number_branch(tree->child[1], tree->rest + 1, next);
}

/* Moves the pieces to their places and lets go of them. */
static void join_branch(branch *tree, ec_bvh_build_node *nodes)
{
    if (!tree->nodes) {
        nodes[tree->slot] = node_of(&tree->range);
        nodes[tree->slot].left = tree->rest;
#pragma omp task if (tree->range.count > 16 * SUBTREE)
        join_branch(tree->child[0], nodes);
        join_branch(tree->child[1], nodes);
#pragma omp taskwait
    } else {
        for (uint32_t i = 0; i < tree->node_count; i++)
            if (!tree->nodes[i].count) tree->nodes[i].left += tree->rest - 1;
        nodes[tree->slot] = tree->nodes[0];
        memcpy(nodes + tree->rest, tree->nodes + 1, (tree->node_count - 1) * sizeof *nodes);
    }
}

static void free_branch(branch *tree)
{
    if (!tree) return;
    free_branch(tree->child[0]);
    free_branch(tree->child[1]);
    free(tree->nodes);
    free(tree);
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
                      branch **tree)
{
    ec_range root = load(builder, positions, indices, count);
#pragma omp taskgroup
    build_branch(builder, &root, tree);
}

static void *allocate_lines(size_t bytes) { return aligned_alloc(64, (bytes + 63) / 64 * 64 + 64); }

ec_result ec_bvh_build(const float *positions, const uint32_t *indices, uint32_t triangle_count, uint32_t threads,
                       ec_bvh *bvh, ec_bvh_stats *stats, ec_error *err)
{
    if (triangle_count > INT32_MAX) return ec_fail(err, "%u triangles are more than a BVH can hold", triangle_count);
    double start = ec_now();
    int team = threads ? (int)threads : omp_get_max_threads();
    ec_builder builder = {0};
    branch *tree = NULL;
    memset(bvh, 0, sizeof *bvh);
    builder.order = malloc((triangle_count + 1) * sizeof *builder.order);
    for (int i = 0; i < 2; i++) builder.prims[i] = allocate_lines(triangle_count * sizeof(ec_prim));
    if (builder.order && builder.prims[0] && builder.prims[1]) {
#pragma omp parallel num_threads(team)
#pragma omp single
        build_all(&builder, positions, indices, triangle_count, &tree);
    } else {
        builder.failed = 1;
    }
    for (int i = 0; i < 2; i++) free(builder.prims[i]);
    if (!builder.failed) {
        bvh->node_count = 1;
        number_branch(tree, 0, &bvh->node_count);
        bvh->nodes = malloc(bvh->node_count * sizeof *bvh->nodes);
    }
    if (bvh->nodes) {
#pragma omp parallel num_threads(team)
#pragma omp single
        join_branch(tree, bvh->nodes);
        bvh->triangle_count = triangle_count;
        bvh->order = builder.order;
        builder.order = NULL;
    }
    free_branch(tree);
    free(builder.order);
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
