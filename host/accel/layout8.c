/* Makes the 8-wide layout: first decides which binary nodes become children of which wide node, then fills the arrays, on all cores. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "accel/layout_internal.h"
#include "accel/leaf.h"

/* A traversal may have the siblings along one path on its stack and eight more children before it takes the next. */
#define STACK_MAX (EC_BVH_STACK - 8)
#define CHUNK 1024u /* nodes or blocks that a thread fills at a time */

typedef struct wide {
    uint32_t child[8]; /* binary nodes; the children that are nodes, then those that are leaves */
    uint32_t node_count, leaf_count;
    uint32_t first_node, first_leaf; /* they are numbered in a row */
} wide;

typedef struct plan {
    const ec_bvh *bvh;
    ec_subtree *subtrees;
    ec_collapse collapse;
    float *promise; /* by binary node, from occlusion.c */
    wide *nodes;
    uint32_t *leaves; /* the binary node of each block */
    uint32_t node_count, leaf_count;
} plan;

/* Lists the children that `index` becomes when given `slots` of them. */
static void gather(const plan *p, uint32_t index, int slots, uint32_t *children, int *count)
{
    const uint8_t *choice = p->collapse.slots[index];
    while (slots > 1 && slots < 8 && !choice[slots]) slots--;
    if (slots == 1) {
        children[(*count)++] = index;
        return;
    }
    uint32_t left = p->bvh->nodes[index].left;
    gather(p, left, choice[slots], children, count);
    gather(p, left + 1, slots - choice[slots], children, count);
}

static int is_leaf(const plan *p, uint32_t index) { return !p->collapse.slots[index][1]; }

/* Lists the best eight children if the stack allows; else the two of the binary tree, of which no path has more than 63. */
static int gather_within(const plan *p, uint32_t index, uint32_t stack, uint32_t *children)
{
    int count = 0;
    gather(p, index, 8, children, &count);
    for (int k = 0; k < count; k++) {
        if (is_leaf(p, children[k]) || p->subtrees[children[k]].height + count - 1 <= stack) continue;
        children[0] = p->bvh->nodes[index].left;
        children[1] = children[0] + 1;
        return 2;
    }
    return count;
}

/* Sorts children so that the best for shadow rays come last: these go through a node's children from the last to the first. */
static void sort_by_promise(const plan *p, uint32_t *children, int count)
{
    for (int i = 1; i < count; i++) {
        uint32_t child = children[i];
        int k = i;
        for (; k > 0 && p->promise[children[k - 1]] > p->promise[child]; k--) children[k] = children[k - 1];
        children[k] = child;
    }
}

/* stack: entries that a traversal below this node may need; at least its height. */
static void plan_node(plan *p, uint32_t at, uint32_t index, uint32_t stack)
{
    uint32_t children[8];
    int count = is_leaf(p, index) ? (children[0] = index, 1) : gather_within(p, index, stack, children);
    sort_by_promise(p, children, count);
    wide *node = &p->nodes[at];
    *node = (wide){.first_node = p->node_count, .first_leaf = p->leaf_count};
    for (int k = 0; k < count; k++)
        if (!is_leaf(p, children[k])) node->child[node->node_count++] = children[k];
    for (int k = 0; k < count; k++) {
        if (!is_leaf(p, children[k])) continue;
        node->child[node->node_count + node->leaf_count++] = children[k];
        p->leaves[p->leaf_count++] = children[k];
    }
    p->node_count += node->node_count;
    for (uint32_t k = 0; k < node->node_count; k++)
        plan_node(p, node->first_node + k, node->child[k], stack - (uint32_t)(count - 1));
}

/* Returns the child that is a leaf: a block, or in a tree of instances one of them. */
static uint32_t leaf_of(const plan *p, const wide *from, uint32_t k)
{
    const uint32_t instance = p->bvh->order[p->bvh->nodes[from->child[k]].first] + 1;
    return EC_LEAF_BIT | (p->bvh->leaf_most == 1 ? EC_INSTANCE_BIT | instance : from->first_leaf + k - from->node_count);
}

/* Orders children for each octant by how far their centres lie along its diagonal. */
static void order_children(ec_bvh8_node *node)
{
    for (uint32_t octant = 0; octant < 4; octant++) { /* the other octants have the opposite order */
        float along[8];
        uint32_t slots[8];
        for (uint32_t k = 0; k < 8; k++) {
            along[k] = 0.0f;
            for (int axis = 0; axis < 3 && node->child[k] != EC_NO_CHILD; axis++) {
                float centre = 0.5f * node->bound[2 * axis][k] + 0.5f * node->bound[2 * axis + 1][k];
                along[k] += octant >> axis & 1 ? -centre : centre;
            }
            uint32_t to = k; /* the farthest first */
            for (; to > 0 && along[slots[to - 1]] < along[k]; to--) slots[to] = slots[to - 1];
            slots[to] = k;
        }
        for (uint32_t k = 0; k < 8; k++) {
            node->order[octant] |= slots[k] << 3 * k;
            node->order[7 - octant] |= slots[k] << 3 * (7 - k);
        }
    }
}

static void fill_node(const plan *p, const wide *from, ec_bvh8_node *node)
{
    memset(node, 0, sizeof *node);
    for (uint32_t k = 0; k < 8; k++) {
        int used = k < from->node_count + from->leaf_count;
        const ec_bvh_build_node *child = used ? &p->bvh->nodes[from->child[k]] : NULL;
        for (int axis = 0; axis < 3; axis++) {
            node->bound[2 * axis][k] = used ? child->lo[axis] : INFINITY;
            node->bound[2 * axis + 1][k] = used ? child->hi[axis] : -INFINITY;
        }
        node->child[k] = !used ? EC_NO_CHILD : k < from->node_count ? from->first_node + k : leaf_of(p, from, k);
    }
    order_children(node);
}

static void fill_block(const plan *p, uint32_t index, const float *positions, const uint32_t *indices, ec_tri8 *block, ec_box8 *boxes)
{
    const uint32_t first = p->bvh->nodes[index].first;
    const ec_box *from = boxes ? p->bvh->boxes + first : NULL;
    ec_block_clear(block, boxes);
    for (uint32_t slot = 0; slot < p->subtrees[index].count; slot++)
        ec_block_put(positions, indices, p->bvh->order[first + slot], from ? from[slot].lo : NULL, from ? from[slot].hi : NULL, slot, block, boxes);
}

static void fill(const plan *p, const float *positions, const uint32_t *indices, ec_bvh8 *made)
{
#pragma omp parallel if (p->leaf_count > CHUNK)
    {
#pragma omp for nowait schedule(dynamic, CHUNK)
        for (uint32_t i = 0; i < p->node_count; i++) fill_node(p, &p->nodes[i], &made->nodes[i]);
#pragma omp for schedule(dynamic, CHUNK)
        for (uint32_t i = 0; i < p->leaf_count; i++)
            fill_block(p, p->leaves[i], positions, indices, &made->blocks[i], made->boxes ? &made->boxes[i] : NULL);
    }
}

static int make_plan(plan *p)
{
    p->subtrees = ec_bvh_subtrees(p->bvh);
    p->promise = ec_bvh_promises(p->bvh);
    if (!p->subtrees || !p->promise || !ec_collapse8(p->bvh, p->subtrees, &p->collapse)) return 0;
    /* A binary tree has one more leaf than inner nodes. Wide nodes are fewer, and untouched memory costs nothing. */
    p->nodes = malloc((p->bvh->node_count / 2 + 1) * sizeof *p->nodes);
    p->leaves = malloc((p->bvh->node_count / 2 + 1) * sizeof *p->leaves);
    if (!p->nodes || !p->leaves) return 0;
    p->node_count = 1;
    plan_node(p, 0, 0, STACK_MAX);
    return 1;
}

static void free_plan(plan *p)
{
    free(p->subtrees);
    free(p->promise);
    free(p->collapse.slots);
    free(p->nodes);
    free(p->leaves);
}

ec_result ec_bvh8_layout(const ec_bvh *bvh, const float *positions, const uint32_t *indices, ec_bvh8 *layout, ec_error *err)
{
    plan p = {.bvh = bvh};
    ec_bvh8 made = {0};
    if (make_plan(&p)) {
        made = (ec_bvh8){.node_count = p.node_count, .block_count = p.leaf_count};
        made.nodes = ec_allocate_lines(p.node_count, sizeof *made.nodes);
        made.blocks = ec_allocate_lines(p.leaf_count, sizeof *made.blocks);
        if (bvh->boxes) made.boxes = ec_allocate_lines(p.leaf_count, sizeof *made.boxes);
    }
    const bool is_whole = made.nodes && made.blocks && (made.boxes || !bvh->boxes);
    if (is_whole) {
        fill(&p, positions, indices, &made);
        *layout = made;
    } else {
        free(made.nodes);
        free(made.blocks);
        free(made.boxes);
    }
    free_plan(&p);
    return is_whole ? EC_OK : ec_fail(err, "out of memory for the 8-wide BVH of %u triangles", bvh->triangle_count);
}

ec_result ec_bvh8_of_boxes(const ec_box *boxes, uint32_t count, uint32_t threads, ec_bvh8 *layout, ec_error *err)
{
    ec_bvh bvh;
    EC_TRY(ec_bvh_build_boxes(boxes, count, threads, &bvh, err));
    plan p = {.bvh = &bvh};
    *layout = (ec_bvh8){0};
    if (make_plan(&p)) layout->nodes = ec_allocate_lines(p.node_count, sizeof *layout->nodes);
    for (uint32_t i = 0; layout->nodes && i < p.node_count; i++) fill_node(&p, &p.nodes[i], &layout->nodes[i]);
    layout->node_count = p.node_count;
    free_plan(&p);
    ec_bvh_free(&bvh);
    return layout->nodes ? EC_OK : ec_fail(err, "out of memory for %u instances", count);
}
