/* Exact SAH for a handful of triangles: weighs every plane between two neighbours on every axis. */
#include <string.h>

#include "accel/layout_internal.h"
#include "accel/leaf.h"

/* In units of one box test: packets of rays test both boxes of a node, and pay four times that for each triangle. */
#define COST_NODE 2.0f
#define COST_TRIANGLE 4.0f

typedef struct sweep {
    ec_box4 box[EC_SWEEP_MAX];        /* by place in the ids given */
    uint8_t order[3][EC_SWEEP_MAX];   /* places sorted by centroid along each axis; a range of each holds the same set */
    uint8_t leaf_order[EC_SWEEP_MAX]; /* places in the order of the leaves */
    uint32_t placed, first;
    ec_bvh2_node *nodes;
    uint32_t *node_count;
} sweep;

typedef struct plane {
    float cost;
    int axis;
    uint32_t left_count;
    ec_box4 left, right;
} plane;

static ec_box4 triangle_box(const float *positions, const uint32_t *indices, uint32_t triangle)
{
    ec_box4 box = ec_box4_empty();
    for (size_t k = 0; k < 3; k++) {
        const float *p = ec_corner(positions, indices, triangle, k);
        ec_v4 v = {p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f, 0.0f}; /* no -0, see prim.c */
        ec_box4_grow(&box, v, v);
    }
    return box;
}

static ec_box4 box4_of(const ec_box *box)
{
    return (ec_box4){{box->lo[0], box->lo[1], box->lo[2], 0.0f}, {box->hi[0], box->hi[1], box->hi[2], 0.0f}};
}

/* Insertion sort, since most ranges come nearly sorted from the builder. Equal centroids keep their order. */
static void sort_axis(sweep *s, int axis, uint32_t count)
{
    float key[EC_SWEEP_MAX];
    uint8_t *order = s->order[axis];
    for (uint32_t i = 0; i < count; i++) {
        float centroid = s->box[i].lo[axis] + s->box[i].hi[axis];
        uint32_t k = i;
        for (; k > 0 && key[k - 1] > centroid; k--) {
            key[k] = key[k - 1];
            order[k] = order[k - 1];
        }
        key[k] = centroid;
        order[k] = (uint8_t)i;
    }
}

/* Grows the boxes on all axes by the triangle at a place of each order. */
static void grow_by(const sweep *s, uint32_t place, ec_box4 box[3])
{
    for (int axis = 0; axis < 3; axis++) {
        const ec_box4 *by = &s->box[s->order[axis][place]];
        ec_box4_grow(&box[axis], by->lo, by->hi);
    }
}

static ec_box4 bound(const sweep *s, int axis, uint32_t begin, uint32_t end)
{
    ec_box4 box = ec_box4_empty();
    for (uint32_t i = begin; i < end; i++) {
        const ec_box4 *by = &s->box[s->order[axis][i]];
        ec_box4_grow(&box, by->lo, by->hi);
    }
    return box;
}

/* Chooses a plane. Where costs are not numbers, or a tree would grow too deep, it takes the middle. */
static plane choose(const sweep *s, uint32_t begin, uint32_t end, uint32_t depth, ec_v4 scale)
{
    ec_v4 right_cost[EC_SWEEP_MAX];
    ec_box4 box[3] = {ec_box4_empty(), ec_box4_empty(), ec_box4_empty()};
    for (uint32_t i = end - 1; i > begin; i--) {
        grow_by(s, i, box);
        right_cost[i - begin] = ec_v4_all((float)(end - i)) * ec_half_areas(box, scale);
    }
    box[0] = box[1] = box[2] = ec_box4_empty();
    plane best = {.cost = INFINITY, .left_count = (end - begin) / 2};
    for (uint32_t i = begin + 1; i < end; i++) {
        grow_by(s, i - 1, box);
        ec_v4 cost = ec_v4_all((float)(i - begin)) * ec_half_areas(box, scale) + right_cost[i - begin];
        uint32_t larger = i - begin > end - i ? i - begin : end - i;
        for (int axis = 0; axis < 3; axis++) {
            if (!(cost[axis] < best.cost) || !ec_depth_allows(depth + 1, larger)) continue;
            best = (plane){.cost = cost[axis], .axis = axis, .left_count = i - begin};
        }
    }
    best.left = bound(s, best.axis, begin, begin + best.left_count);
    best.right = bound(s, best.axis, begin + best.left_count, end);
    return best;
}

/* Divides a range; on the axes that were not split, each side keeps its order. */
static void divide(sweep *s, const plane *p, uint32_t begin, uint32_t end)
{
    uint8_t on_right[EC_SWEEP_MAX], right[EC_SWEEP_MAX];
    uint32_t middle = begin + p->left_count;
    for (uint32_t i = begin; i < end; i++) on_right[s->order[p->axis][i]] = i >= middle;
    for (int axis = 0; axis < 3; axis++) {
        uint32_t left_count = begin, right_count = 0;
        uint8_t *order = s->order[axis];
        for (uint32_t i = begin; i < end; i++) {
            uint8_t place = order[i];
            if (on_right[place]) right[right_count++] = place;
            else order[left_count++] = place;
        }
        memcpy(order + left_count, right, right_count);
    }
}

static void set_child(ec_bvh2_node *node, int side, const ec_box4 *box, uint32_t child)
{
    for (int axis = 0; axis < 3; axis++) {
        node->lo[side][axis] = box->lo[axis];
        node->hi[side][axis] = box->hi[axis];
    }
    node->child[side] = child;
}

static uint32_t build(sweep *s, const ec_box4 *box, uint32_t begin, uint32_t end, uint32_t depth)
{
    uint32_t count = end - begin;
    ec_v4 scale = ec_box4_scale(box);
    const ec_box4 parent[3] = {*box, *box, *box};
    float area = ec_half_areas(parent, scale)[0];
    plane best = {.cost = INFINITY};
    if (count > 1) best = choose(s, begin, end, depth, scale);
    float split_cost = COST_NODE * area + COST_TRIANGLE * best.cost;
    if (count <= EC_SWEEP_LEAF && !(split_cost < COST_TRIANGLE * (float)count * area)) {
        uint32_t first = s->first + s->placed;
        for (uint32_t i = begin; i < end; i++) s->leaf_order[s->placed++] = s->order[0][i];
        return EC_LEAF_BIT | first << 4 | count;
    }
    divide(s, &best, begin, end);
    uint32_t index = (*s->node_count)++;
    memset(&s->nodes[index], 0, sizeof s->nodes[index]);
    set_child(&s->nodes[index], 0, &best.left, build(s, &best.left, begin, begin + best.left_count, depth + 1));
    set_child(&s->nodes[index], 1, &best.right, build(s, &best.right, begin + best.left_count, end, depth + 1));
    return index;
}

uint32_t ec_sweep_build(const float *positions, const uint32_t *indices, uint32_t *ids, ec_box *boxes, uint32_t count,
                        uint32_t first, uint32_t depth, ec_bvh2_node *nodes, uint32_t *node_count)
{
    sweep s = {.first = first, .nodes = nodes, .node_count = node_count};
    uint32_t given[EC_SWEEP_MAX];
    for (uint32_t i = 0; i < count; i++)
        s.box[i] = boxes ? box4_of(&boxes[i]) : triangle_box(positions, indices, ids[i]);
    for (int axis = 0; axis < 3; axis++) sort_axis(&s, axis, count);
    ec_box4 box = bound(&s, 0, 0, count);
    uint32_t root = build(&s, &box, 0, count, depth);
    memcpy(given, ids, count * sizeof *ids);
    for (uint32_t i = 0; i < count; i++) ids[i] = given[s.leaf_order[i]];
    for (uint32_t i = 0; boxes && i < count; i++) {
        memcpy(boxes[i].lo, &s.box[s.leaf_order[i]].lo, sizeof boxes[i].lo);
        memcpy(boxes[i].hi, &s.box[s.leaf_order[i]].hi, sizeof boxes[i].hi);
    }
    return root;
}
