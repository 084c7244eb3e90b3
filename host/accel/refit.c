/* Refits boxes from the leaves up: the leaves on all cores, since they are most of the work, then the nodes above them. In both layouts children lie
 * behind their parents, so that one sweep from the end is enough. */
#include "accel/refit.h"

#include <string.h>

#include "accel/accel_internal.h"
#include "accel/leaf.h"

/* A BVH of either layout: nodes of eight children over blocks, or of two over runs of triangles. */
typedef struct tree {
    ec_bvh8_node *wide;      /* NULL: the layout is the binary one */
    ec_bvh2_node *binary;
    void *leaves, *boxes;    /* boxes: NULL where no triangle moves */
    uint64_t count;
    int width;
} tree;

static bool is(uint32_t which, const char *name) { return which == ec_accel_find(name); }

bool ec_accel_can_refit(uint32_t which) { return is(which, "bvh2") || is(which, "bvh8"); }

static tree tree_of(uint32_t which, const ec_accel *accel)
{
    const ec_accel_buffer *b = accel->buffers;
    tree t = {.leaves = b[1].data, .boxes = b[2].data};
    if (is(which, "bvh8")) t.wide = b[0].data, t.width = 8, t.count = b[0].bytes / sizeof *t.wide;
    else t.binary = b[0].data, t.width = 2, t.count = b[0].bytes / sizeof *t.binary;
    return t;
}

static uint32_t child_of(const tree *t, uint64_t node, int k) { return t->wide ? t->wide[node].child[k] : t->binary[node].child[k]; }

static bool is_leaf(uint32_t child) { return child != EC_NO_CHILD && child & EC_LEAF_BIT; }

static ec_box child_box(const tree *t, uint64_t node, int k)
{
    ec_box b;
    for (int axis = 0; axis < 3; axis++) {
        b.lo[axis] = t->wide ? t->wide[node].bound[2 * axis][k] : t->binary[node].lo[k][axis];
        b.hi[axis] = t->wide ? t->wide[node].bound[2 * axis + 1][k] : t->binary[node].hi[k][axis];
    }
    return b;
}

static void set_child_box(const tree *t, uint64_t node, int k, ec_box b)
{
    for (int axis = 0; axis < 3; axis++) {
        *(t->wide ? &t->wide[node].bound[2 * axis][k] : &t->binary[node].lo[k][axis]) = b.lo[axis];
        *(t->wide ? &t->wide[node].bound[2 * axis + 1][k] : &t->binary[node].hi[k][axis]) = b.hi[axis];
    }
}

static ec_box node_box(const tree *t, uint64_t node)
{
    ec_box all = EC_NO_BOX;
    for (int k = 0; k < t->width; k++) {
        const ec_box child = child_box(t, node, k);
        if (child_of(t, node, k) != EC_NO_CHILD) ec_box_grow(&all, child.lo, child.hi);
    }
    return all;
}

/* Returns a triangle's box, as the builder bounds it: the swept box, if it moves while the shutter is open. No -0. */
static ec_box box_of(const ec_accel_input *in, uint32_t id)
{
    ec_box b;
    if (id < in->swept_count) memcpy(&b, in->swept + 6 * (size_t)id, sizeof b);
    else b = ec_triangle_box(in->positions, in->indices, id);
    for (int k = 0; k < 3; k++) b.lo[k] += 0.0f, b.hi[k] += 0.0f;
    return b;
}

static ec_box refit_block(const ec_accel_input *in, ec_tri8 *block, ec_box8 *boxes)
{
    ec_box all = EC_NO_BOX;
    for (uint32_t slot = 0; slot < 8 && block->id[slot] != EC_NO_ID; slot++) {
        const ec_box own = box_of(in, block->id[slot]);
        ec_block_put(in->positions, in->indices, block->id[slot], own.lo, own.hi, slot, block, boxes);
        ec_box_grow(&all, own.lo, own.hi);
    }
    return all;
}

/* Returns whether two triangles still form a quad: they are tested together only as long as they share an edge, to the bit. */
static bool is_still_pair(const ec_accel_input *in, const ec_tri *first)
{
    const bool moves = first[0].id < in->swept_count || first[1].id < in->swept_count;
    return !moves && !memcmp(first[0].v0, first[1].v0, sizeof first->v0) && !memcmp(first[0].v2, first[1].v1, sizeof first->v2);
}

static ec_box refit_run(const ec_accel_input *in, ec_tri *leaf, ec_box *boxes, uint32_t count)
{
    ec_box all = EC_NO_BOX;
    for (uint32_t i = 0; i < count; i++) {
        const ec_box own = box_of(in, leaf[i].id);
        const uint32_t has_pair = leaf[i].has_pair;
        leaf[i] = ec_tri_of(in->positions, in->indices, leaf[i].id);
        leaf[i].has_pair = has_pair;
        if (boxes) boxes[i] = own;
        ec_box_grow(&all, own.lo, own.hi);
    }
    for (uint32_t i = 0; i < count; i++)
        if (leaf[i].has_pair) leaf[i].has_pair = is_still_pair(in, &leaf[i]);
    return all;
}

static ec_box refit_leaf(const ec_accel_input *in, const tree *t, uint32_t child)
{
    const uint32_t block = child & ~EC_LEAF_BIT, first = block >> 4;
    if (t->wide) return refit_block(in, (ec_tri8 *)t->leaves + block, t->boxes ? (ec_box8 *)t->boxes + block : NULL);
    return refit_run(in, (ec_tri *)t->leaves + first, t->boxes ? (ec_box *)t->boxes + first : NULL, child & 15u);
}

void ec_accel_refit(uint32_t which, const ec_accel_input *in, ec_accel *accel)
{
    const tree t = tree_of(which, accel);
#pragma omp parallel for schedule(dynamic, 256) num_threads(ec_accel_threads(in, in->triangle_count))
    for (uint64_t i = 0; i < t.count; i++)
        for (int k = 0; k < t.width; k++)
            if (is_leaf(child_of(&t, i, k))) set_child_box(&t, i, k, refit_leaf(in, &t, child_of(&t, i, k)));
    for (uint64_t i = t.count; i-- > 0;)
        for (int k = 0; k < t.width; k++)
            if (!(child_of(&t, i, k) & EC_LEAF_BIT)) set_child_box(&t, i, k, node_box(&t, child_of(&t, i, k)));
}

/* Returns the cost of visiting a child. A wide node and a block cost the same (collapse8.c); in box tests, a node of two costs two and each triangle
 * four (sweep.c). */
static double cost_of(const tree *t, uint32_t child)
{
    if (child == EC_NO_CHILD) return 0;
    return t->wide ? 1 : is_leaf(child) ? 4.0 * (child & 15u) : 2;
}

double ec_accel_expense(uint32_t which, const ec_accel *accel)
{
    if (!ec_accel_can_refit(which)) return 0;
    const tree t = tree_of(which, accel);
    const ec_box root = node_box(&t, 0);
    const double whole = ec_box_half_area(root.lo, root.hi);
    double sum = 0;
    for (uint64_t i = 0; i < t.count; i++)
        for (int k = 0; k < t.width; k++) {
            const ec_box child = child_box(&t, i, k);
            sum += ec_box_half_area(child.lo, child.hi) * cost_of(&t, child_of(&t, i, k));
        }
    return whole > 0 ? sum / whole : 0;
}
