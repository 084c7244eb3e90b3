/* Boxes from the leaves up: the leaves on all cores, since they are most of the work, then the nodes above them. In all layouts children lie
 * behind their parents, so that one sweep from the end does. */
#include "accel/refit.h"

#include "accel/accel_internal.h"

#include <math.h>
#include <string.h>

typedef struct box {
    float lo[3], hi[3];
} box;

static const box nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void grow(box *b, const float *lo, const float *hi)
{
    for (int k = 0; k < 3; k++) {
        b->lo[k] = fminf(b->lo[k], lo[k]);
        b->hi[k] = fmaxf(b->hi[k], hi[k]);
    }
}

/* As the builder bounds it: what it sweeps, where it moves while the shutter is open. No -0. */
static box box_of(const ec_accel_input *in, uint32_t id)
{
    box b = nothing;
    if (id < in->swept_count) {
        grow(&b, in->swept + 6 * (size_t)id, in->swept + 6 * (size_t)id + 3);
    } else {
        for (size_t c = 0; c < 3; c++) {
            const float *v = in->positions + 3 * (size_t)in->indices[3 * (size_t)id + c];
            grow(&b, v, v);
        }
    }
    for (int k = 0; k < 3; k++) b.lo[k] += 0.0f, b.hi[k] += 0.0f;
    return b;
}

static double half_area(const box *b)
{
    double x = (double)b->hi[0] - b->lo[0], y = (double)b->hi[1] - b->lo[1], z = (double)b->hi[2] - b->lo[2];
    return x >= 0 ? x * y + y * z + z * x : 0;
}

/* Eight-wide */

static box node8_child(const ec_bvh8_node *n, int k)
{
    box b;
    for (int axis = 0; axis < 3; axis++) b.lo[axis] = n->bound[2 * axis][k], b.hi[axis] = n->bound[2 * axis + 1][k];
    return b;
}

static box node8_box(const ec_bvh8_node *n)
{
    box all = nothing;
    for (int k = 0; k < 8; k++) {
        box child = node8_child(n, k);
        if (n->child[k] != EC_NO_CHILD) grow(&all, child.lo, child.hi);
    }
    return all;
}

static box refit_block(const ec_accel_input *in, ec_tri8 *block, ec_box8 *boxes)
{
    box all = nothing;
    for (int slot = 0; slot < 8 && block->id[slot] != EC_NO_ID; slot++) {
        uint32_t id = block->id[slot];
        box own = box_of(in, id);
        for (size_t c = 0; c < 3; c++)
            for (size_t axis = 0; axis < 3; axis++)
                block->v[c][axis][slot] = in->positions[3 * (size_t)in->indices[3 * (size_t)id + c] + axis];
        for (int axis = 0; boxes && axis < 3; axis++) boxes->lo[axis][slot] = own.lo[axis], boxes->hi[axis][slot] = own.hi[axis];
        grow(&all, own.lo, own.hi);
    }
    return all;
}

static void set_child8(ec_bvh8_node *n, int k, const box *b)
{
    for (int axis = 0; axis < 3; axis++) n->bound[2 * axis][k] = b->lo[axis], n->bound[2 * axis + 1][k] = b->hi[axis];
}

static void refit8(const ec_accel_input *in, ec_bvh8_node *nodes, uint64_t node_count, ec_tri8 *blocks, ec_box8 *boxes)
{
#pragma omp parallel for schedule(dynamic, 256) num_threads(ec_accel_threads(in, in->triangle_count))
    for (uint64_t i = 0; i < node_count; i++)
        for (int k = 0; k < 8; k++) {
            uint32_t child = nodes[i].child[k], block = child & ~EC_LEAF_BIT;
            if (child == EC_NO_CHILD || !(child & EC_LEAF_BIT)) continue;
            box b = refit_block(in, &blocks[block], boxes ? &boxes[block] : NULL);
            set_child8(&nodes[i], k, &b);
        }
    for (uint64_t i = node_count; i-- > 0;)
        for (int k = 0; k < 8; k++) {
            if (nodes[i].child[k] & EC_LEAF_BIT) continue;
            box b = node8_box(&nodes[nodes[i].child[k]]);
            set_child8(&nodes[i], k, &b);
        }
}

/* A node and a block cost the same (collapse8.c). */
static double expense8(const ec_bvh8_node *nodes, uint64_t node_count)
{
    double sum = 0;
    box root = node8_box(&nodes[0]);
    for (uint64_t i = 0; i < node_count; i++)
        for (int k = 0; k < 8; k++) {
            box child = node8_child(&nodes[i], k);
            if (nodes[i].child[k] != EC_NO_CHILD) sum += half_area(&child);
        }
    return half_area(&root) > 0 ? sum / half_area(&root) : 0;
}

/* Binary */

/* Two of them are tested together only as long as they share an edge, to the bit. */
static void keep_pairs(const ec_accel_input *in, ec_tri *leaf, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!leaf[i].has_pair) continue;
        bool moves = leaf[i].id < in->swept_count || leaf[i + 1].id < in->swept_count;
        if (moves || memcmp(leaf[i].v0, leaf[i + 1].v0, sizeof leaf->v0) ||
            memcmp(leaf[i].v2, leaf[i + 1].v1, sizeof leaf->v0))
            leaf[i].has_pair = 0;
    }
}

static box refit_leaf(const ec_accel_input *in, ec_tri *leaf, ec_box *boxes, uint32_t count)
{
    box all = nothing;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *corner = in->indices + 3 * (size_t)leaf[i].id;
        box own = box_of(in, leaf[i].id);
        memcpy(leaf[i].v0, in->positions + 3 * (size_t)corner[0], sizeof leaf->v0);
        memcpy(leaf[i].v1, in->positions + 3 * (size_t)corner[1], sizeof leaf->v1);
        memcpy(leaf[i].v2, in->positions + 3 * (size_t)corner[2], sizeof leaf->v2);
        if (boxes) memcpy(&boxes[i], &own, sizeof own);
        grow(&all, own.lo, own.hi);
    }
    keep_pairs(in, leaf, count);
    return all;
}

static box node2_box(const ec_bvh2_node *n)
{
    box all = nothing;
    for (int side = 0; side < 2; side++)
        if (n->child[side] != EC_NO_CHILD) grow(&all, n->lo[side], n->hi[side]);
    return all;
}

static void set_child2(ec_bvh2_node *n, int side, const box *b)
{
    memcpy(n->lo[side], b->lo, sizeof b->lo);
    memcpy(n->hi[side], b->hi, sizeof b->hi);
}

static void refit2(const ec_accel_input *in, ec_bvh2_node *nodes, uint64_t node_count, ec_tri *triangles, ec_box *boxes)
{
#pragma omp parallel for schedule(dynamic, 1024) num_threads(ec_accel_threads(in, in->triangle_count))
    for (uint64_t i = 0; i < node_count; i++)
        for (int side = 0; side < 2; side++) {
            uint32_t child = nodes[i].child[side], first = (child & ~EC_LEAF_BIT) >> 4;
            if (child == EC_NO_CHILD || !(child & EC_LEAF_BIT)) continue;
            box b = refit_leaf(in, triangles + first, boxes ? boxes + first : NULL, child & 15u);
            set_child2(&nodes[i], side, &b);
        }
    for (uint64_t i = node_count; i-- > 0;)
        for (int side = 0; side < 2; side++) {
            if (nodes[i].child[side] & EC_LEAF_BIT) continue;
            box b = node2_box(&nodes[nodes[i].child[side]]);
            set_child2(&nodes[i], side, &b);
        }
}

/* In box tests; a triangle costs four (sweep.c). */
static double expense2(const ec_bvh2_node *nodes, uint64_t node_count)
{
    double sum = 0;
    box root = node2_box(&nodes[0]);
    for (uint64_t i = 0; i < node_count; i++)
        for (int side = 0; side < 2; side++) {
            uint32_t child = nodes[i].child[side];
            box b;
            memcpy(b.lo, nodes[i].lo[side], sizeof b.lo);
            memcpy(b.hi, nodes[i].hi[side], sizeof b.hi);
            if (child != EC_NO_CHILD) sum += half_area(&b) * (child & EC_LEAF_BIT ? 4.0 * (child & 15u) : 2.0);
        }
    return half_area(&root) > 0 ? sum / half_area(&root) : 0;
}

static bool is(uint32_t which, const char *name) { return which == ec_accel_find(name); }

bool ec_accel_can_refit(uint32_t which) { return is(which, "bvh2") || is(which, "bvh8"); }

static uint64_t count_of(const ec_accel *accel, size_t size) { return accel->buffers[0].bytes / size; }

void ec_accel_refit(uint32_t which, const ec_accel_input *in, ec_accel *accel)
{
    void *const nodes = accel->buffers[0].data, *const triangles = accel->buffers[1].data, *const boxes = accel->buffers[2].data;
    if (is(which, "bvh2")) refit2(in, nodes, count_of(accel, sizeof(ec_bvh2_node)), triangles, boxes);
    if (is(which, "bvh8")) refit8(in, nodes, count_of(accel, sizeof(ec_bvh8_node)), triangles, boxes);
}

double ec_accel_expense(uint32_t which, const ec_accel *accel)
{
    const void *nodes = accel->buffers[0].data;
    if (is(which, "bvh2")) return expense2(nodes, count_of(accel, sizeof(ec_bvh2_node)));
    if (is(which, "bvh8")) return expense8(nodes, count_of(accel, sizeof(ec_bvh8_node)));
    return 0;
}
