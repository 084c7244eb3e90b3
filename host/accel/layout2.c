/* Makes the binary layout. The upper tree is the builder's; subtrees of at most EC_SWEEP_MAX triangles are built anew by exact SAH, because the
 * builder charges for blocks of eight and these kernels pay for every triangle. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/layout_internal.h"
#include "accel/leaf.h"

#define GROUP 64u /* subtrees that share one piece of memory while they are built */

typedef struct subtree {
    uint32_t root;   /* in the builder's tree */
    uint32_t depth;
    uint32_t parent; /* upper node, and which of its children */
    uint32_t side;
    uint32_t child;  /* reference to the new root, its nodes numbered within the group */
} subtree;

typedef struct group {
    ec_bvh2_node *nodes;
    uint32_t node_count, offset;
} group;

typedef struct plan {
    const ec_bvh *bvh;
    const float *positions;
    const uint32_t *indices;
    ec_subtree *below;
    ec_bvh2_node *upper;
    subtree *subtrees;
    group *groups;
    uint32_t *ids; /* triangles in the order of the new leaves */
    ec_box *boxes; /* likewise; NULL if the tree has none */
    uint32_t upper_count, subtree_count, group_count;
    int failed;
} plan;

static void set_box(const plan *p, ec_bvh2_node *node, uint32_t side, uint32_t from)
{
    memcpy(node->lo[side], p->bvh->nodes[from].lo, sizeof node->lo[side]);
    memcpy(node->hi[side], p->bvh->nodes[from].hi, sizeof node->hi[side]);
}

/* Copies the upper tree and lists the subtrees below it, from left to right. Returns the new index of `index`. */
static uint32_t plan_upper(plan *p, uint32_t index, uint32_t depth)
{
    uint32_t at = p->upper_count++;
    memset(&p->upper[at], 0, sizeof p->upper[at]);
    for (uint32_t side = 0; side < 2; side++) {
        uint32_t child = p->bvh->nodes[index].left + side;
        set_box(p, &p->upper[at], side, child);
        if (p->below[child].count > EC_SWEEP_MAX)
            p->upper[at].child[side] = plan_upper(p, child, depth + 1);
        else
            p->subtrees[p->subtree_count++] = (subtree){.root = child, .depth = depth + 1, .parent = at, .side = side};
    }
    return at;
}

static void build_group(plan *p, uint32_t index)
{
    group *g = &p->groups[index];
    uint32_t begin = index * GROUP, end = begin + GROUP < p->subtree_count ? begin + GROUP : p->subtree_count;
    uint32_t triangles = 0;
    for (uint32_t i = begin; i < end; i++) triangles += p->below[p->subtrees[i].root].count;
    g->nodes = malloc((triangles + 1) * sizeof *g->nodes);
    if (!g->nodes) {
#pragma omp atomic write
        p->failed = 1;
        return;
    }
    for (uint32_t i = begin; i < end; i++) {
        subtree *s = &p->subtrees[i];
        uint32_t first = p->bvh->nodes[s->root].first, count = p->below[s->root].count;
        s->child = ec_sweep_build(p->positions, p->indices, p->ids + first, p->boxes ? p->boxes + first : NULL, count,
                                  first, s->depth, g->nodes, &g->node_count);
    }
    ec_bvh2_node *trimmed = realloc(g->nodes, (g->node_count + 1) * sizeof *g->nodes);
    if (trimmed) g->nodes = trimmed;
}

static uint32_t moved(uint32_t child, uint32_t offset) { return child & EC_LEAF_BIT ? child : child + offset; }

static void join_group(plan *p, uint32_t index, ec_bvh2_node *nodes)
{
    group *g = &p->groups[index];
    for (uint32_t i = 0; i < g->node_count; i++) {
        ec_bvh2_node node = g->nodes[i];
        for (int side = 0; side < 2; side++) node.child[side] = moved(node.child[side], g->offset);
        nodes[g->offset + i] = node;
    }
    for (uint32_t i = index * GROUP; i < p->subtree_count && i < (index + 1) * GROUP; i++) {
        const subtree *s = &p->subtrees[i];
        nodes[s->parent].child[s->side] = moved(s->child, g->offset);
    }
}

static int allocate_plan(plan *p)
{
    p->below = ec_bvh_subtrees(p->bvh);
    p->upper = malloc(p->bvh->node_count * sizeof *p->upper); /* far more than needed, and never touched */
    p->subtrees = malloc(p->bvh->node_count * sizeof *p->subtrees);
    if (!p->below || !p->upper || !p->subtrees) return 0;
    plan_upper(p, 0, 0);
    p->group_count = (p->subtree_count + GROUP - 1) / GROUP;
    p->groups = calloc(p->group_count, sizeof *p->groups);
    return p->groups != NULL;
}

static int copy_references(plan *p)
{
    size_t count = p->bvh->ref_count;
    p->ids = malloc((count + 1) * sizeof *p->ids);
    if (p->bvh->boxes) p->boxes = malloc(count * sizeof *p->boxes);
    if (!p->ids || (p->bvh->boxes && !p->boxes)) return 0;
    memcpy(p->ids, p->bvh->order, count * sizeof *p->ids);
    if (p->boxes) memcpy(p->boxes, p->bvh->boxes, count * sizeof *p->boxes);
    return 1;
}

static void free_plan(plan *p)
{
    for (uint32_t i = 0; p->groups && i < p->group_count; i++) free(p->groups[i].nodes);
    free(p->groups);
    free(p->below);
    free(p->upper);
    free(p->subtrees);
    free(p->ids);
    free(p->boxes);
}

/* Builds the nodes of a tree of more than EC_SWEEP_MAX triangles; returns NULL when out of memory. */
static ec_bvh2_node *build_large(plan *p, uint32_t *node_count)
{
    if (!allocate_plan(p)) return NULL;
#pragma omp parallel for schedule(dynamic, 1)
    for (uint32_t i = 0; i < p->group_count; i++) build_group(p, i);
    if (p->failed) return NULL;
    *node_count = p->upper_count;
    for (uint32_t i = 0; i < p->group_count; i++) {
        p->groups[i].offset = *node_count;
        *node_count += p->groups[i].node_count;
    }
    ec_bvh2_node *nodes = ec_allocate_lines(*node_count, sizeof *nodes);
    if (!nodes) return NULL;
    memcpy(nodes, p->upper, p->upper_count * sizeof *nodes);
#pragma omp parallel for schedule(dynamic, 1)
    for (uint32_t i = 0; i < p->group_count; i++) join_group(p, i, nodes);
    return nodes;
}

/* Builds any smaller tree. A root is always a node, if need be with a single child. */
static ec_bvh2_node *build_small(plan *p, uint32_t *node_count)
{
    uint32_t count = p->bvh->ref_count;
    ec_bvh2_node *nodes = ec_allocate_lines(count, sizeof *nodes);
    if (!nodes) return NULL;
    *node_count = 0;
    uint32_t root = ec_sweep_build(p->positions, p->indices, p->ids, p->boxes, count, 0, 0, nodes, node_count);
    if (root & EC_LEAF_BIT) {
        *node_count = 1;
        memset(&nodes[0], 0, sizeof nodes[0]);
        set_box(p, &nodes[0], 0, 0);
        nodes[0].child[0] = root;
        nodes[0].child[1] = EC_NO_CHILD;
        for (int axis = 0; axis < 3; axis++) {
            nodes[0].lo[1][axis] = INFINITY;
            nodes[0].hi[1][axis] = -INFINITY;
        }
    }
    return nodes;
}

static void fill_triangles(const plan *p, ec_tri *triangles)
{
#pragma omp parallel for schedule(dynamic, 4096) if (p->bvh->ref_count > 4096)
    for (uint32_t i = 0; i < p->bvh->ref_count; i++) triangles[i] = ec_tri_of(p->positions, p->indices, p->ids[i]);
}

/* Returns whether `second` completes `first` to a quad: (p, q, r) and (p, r, s). Moving triangles do not, since they may part. */
static int is_quad(const ec_tri *first, const ec_tri *second, uint32_t moving)
{
    return first->id >= moving && second->id >= moving && !memcmp(first->v0, second->v0, sizeof first->v0) &&
           !memcmp(first->v2, second->v1, sizeof first->v2);
}

static void exchange(ec_tri *leaf, ec_box *boxes, uint32_t i, uint32_t k)
{
    ec_tri tri = leaf[i];
    leaf[i] = leaf[k];
    leaf[k] = tri;
    if (!boxes) return;
    ec_box box = boxes[i];
    boxes[i] = boxes[k];
    boxes[k] = box;
}

/* Brings the two halves of quads together within one leaf. */
static void pair_leaf(ec_tri *leaf, ec_box *boxes, uint32_t count, uint32_t moving)
{
    for (uint32_t i = 0; i + 1 < count; i++) {
        uint32_t k = i + 1;
        while (k < count && !is_quad(&leaf[i], &leaf[k], moving) && !is_quad(&leaf[k], &leaf[i], moving)) k++;
        if (k == count) continue;
        exchange(leaf, boxes, i + 1, k);
        if (!is_quad(&leaf[i], &leaf[i + 1], moving)) exchange(leaf, boxes, i, i + 1);
        leaf[i++].has_pair = 1;
    }
}

static void pair_leaves(const ec_bvh2_node *nodes, uint32_t node_count, uint32_t moving, ec_tri *triangles, ec_box *boxes)
{
#pragma omp parallel for schedule(dynamic, 4096) if (node_count > 4096)
    for (uint32_t i = 0; i < node_count; i++)
        for (int side = 0; side < 2; side++) {
            uint32_t child = nodes[i].child[side];
            if (child == EC_NO_CHILD || !(child & EC_LEAF_BIT)) continue;
            uint32_t first = (child & ~EC_LEAF_BIT) >> 4;
            pair_leaf(triangles + first, boxes ? boxes + first : NULL, child & 15u, moving);
        }
}

ec_result ec_bvh2_layout(const ec_bvh *bvh, const float *positions, const uint32_t *indices, ec_bvh2 *layout, ec_error *err)
{
    if (bvh->ref_count >= 1u << 27)
        return ec_fail(err, "%u triangles are more than the binary BVH layout can number", bvh->triangle_count);
    plan p = {.bvh = bvh, .positions = positions, .indices = indices};
    ec_bvh2 made = {.triangle_count = bvh->ref_count};
    if (copy_references(&p))
        made.nodes = bvh->ref_count > EC_SWEEP_MAX ? build_large(&p, &made.node_count) : build_small(&p, &made.node_count);
    if (made.nodes) made.triangles = ec_allocate_lines(bvh->ref_count, sizeof *made.triangles);
    if (made.triangles) {
        fill_triangles(&p, made.triangles);
        pair_leaves(made.nodes, made.node_count, bvh->moving_count, made.triangles, p.boxes);
        made.boxes = p.boxes;
        p.boxes = NULL;
        *layout = made;
    } else {
        free(made.nodes);
    }
    free_plan(&p);
    return made.triangles ? EC_OK : ec_fail(err, "out of memory for the binary BVH of %u triangles", bvh->triangle_count);
}
