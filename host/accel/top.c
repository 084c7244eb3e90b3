/* A range of instances becomes up to eight by splitting the largest of them again and again, each where the surface area heuristic
 * says (Goldsmith and Salmon 1987), swept over all places along all axes: instances are few beside triangles, and each costs a
 * whole tree to enter, so that leaves hold one. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "accel/build_internal.h"
#include "accel/leaf.h"

typedef struct part {
    uint32_t first, count;
    ec_box box;
} part;

typedef struct builder {
    const ec_box *boxes;
    uint32_t *order;     /* of the boxes */
    uint32_t *scratch;
    float *key;          /* by box: its centre along the axis of now */
    double *area;        /* of what lies right of a place */
    ec_bvh8_node *nodes;
    uint32_t used;
} builder;

static void grow(ec_box *box, const ec_box *by) { ec_box_grow(box, by->lo, by->hi); }
static double area(const ec_box *b) { return ec_box_half_area(b->lo, b->hi); }

static ec_box box_of(const builder *b, uint32_t first, uint32_t count)
{
    ec_box box = b->boxes[b->order[first]];
    for (uint32_t i = 1; i < count; i++) grow(&box, &b->boxes[b->order[first + i]]);
    return box;
}

/* Merge sort by key: stable, so that the tree is the same everywhere. */
static void sort(builder *b, uint32_t first, uint32_t count)
{
    if (count < 2) return;
    uint32_t half = count / 2, i = first, j = first + half, end = first + count, to = 0;
    sort(b, first, half);
    sort(b, j, count - half);
    while (i < first + half && j < end)
        b->scratch[to++] = b->key[b->order[j]] < b->key[b->order[i]] ? b->order[j++] : b->order[i++];
    while (i < first + half) b->scratch[to++] = b->order[i++];
    while (j < end) b->scratch[to++] = b->order[j++];
    memcpy(b->order + first, b->scratch, count * sizeof *b->order);
}

static void sort_along(builder *b, const part *p, int axis)
{
    for (uint32_t i = 0; i < p->count; i++) {
        const ec_box *box = &b->boxes[b->order[p->first + i]];
        b->key[b->order[p->first + i]] = 0.5f * box->lo[axis] + 0.5f * box->hi[axis];
    }
    sort(b, p->first, p->count);
}

/* The best place along the axis that the range is sorted by: area times count on both sides. */
static uint32_t sweep(builder *b, const part *p, double *cost)
{
    ec_box box = b->boxes[b->order[p->first + p->count - 1]];
    uint32_t best = p->count / 2;
    *cost = INFINITY;
    for (uint32_t i = p->count - 1; i > 0; i--) {
        grow(&box, &b->boxes[b->order[p->first + i]]);
        b->area[i] = area(&box);
    }
    box = b->boxes[b->order[p->first]];
    for (uint32_t i = 1; i < p->count; i++) {
        double c = area(&box) * i + b->area[i] * (p->count - i);
        if (c < *cost) *cost = c, best = i;
        grow(&box, &b->boxes[b->order[p->first + i]]);
    }
    return best;
}

static void split(builder *b, const part *p, bool halve, part sides[2])
{
    double best_cost = INFINITY;
    int best_axis = 0;
    uint32_t left = p->count / 2;
    for (int axis = 0; axis < 3; axis++) {
        double cost;
        sort_along(b, p, axis);
        uint32_t at = sweep(b, p, &cost);
        if (cost < best_cost) best_cost = cost, best_axis = axis, left = at;
    }
    sort_along(b, p, best_axis);
    if (halve) left = p->count / 2;
    sides[0] = (part){p->first, left, box_of(b, p->first, left)};
    sides[1] = (part){p->first + left, p->count - left, box_of(b, p->first + left, p->count - left)};
}

/* Which part to split next; 8: none. */
static uint32_t choose(const part *parts, uint32_t count, bool halve)
{
    uint32_t best = 8;
    double most = -1.0;
    for (uint32_t i = 0; i < count; i++) {
        double size = halve ? parts[i].count : area(&parts[i].box) * parts[i].count;
        if (parts[i].count > 1 && size > most) most = size, best = i;
    }
    return best;
}

static uint32_t divide(builder *b, const part *range, bool halve, part parts[8])
{
    uint32_t count = 1;
    parts[0] = *range;
    while (count < 8) {
        uint32_t next = choose(parts, count, halve);
        if (next == 8) break;
        part sides[2];
        split(b, &parts[next], halve, sides);
        parts[next] = sides[0];
        parts[count++] = sides[1];
    }
    return count;
}

/* Fills node `at` and all below it; levels: nodes that a path may go on with after this one. What these could not hold is halved
 * three times over, which leaves to each child an eighth. */
static void build(builder *b, const part *range, uint32_t at, uint32_t levels)
{
    part parts[8];
    uint32_t count = divide(b, range, levels < 10 && range->count > (1u << (3 * levels)), parts);
    ec_bvh8_node *node = &b->nodes[at];
    memset(node, 0, sizeof *node);
    for (uint32_t k = 0; k < 8; k++) {
        for (int axis = 0; axis < 3; axis++) {
            node->bound[2 * axis][k] = k < count ? parts[k].box.lo[axis] : INFINITY;
            node->bound[2 * axis + 1][k] = k < count ? parts[k].box.hi[axis] : -INFINITY;
        }
        node->child[k] = EC_NO_CHILD;
        if (k < count && parts[k].count == 1) node->child[k] = EC_LEAF_BIT | EC_INSTANCE_BIT | (b->order[parts[k].first] + 1);
        if (k < count && parts[k].count > 1) node->child[k] = b->used++;
    }
    for (uint32_t k = 0; k < count; k++)
        if (parts[k].count > 1) build(b, &parts[k], b->nodes[at].child[k], levels - 1);
}

int ec_top_build(const ec_box *boxes, uint32_t count, ec_bvh8_node *nodes, uint32_t *used)
{
    builder b = {.boxes = boxes, .nodes = nodes, .used = 1};
    b.order = malloc((size_t)count * sizeof *b.order);
    b.scratch = malloc((size_t)count * sizeof *b.scratch);
    b.key = malloc((size_t)count * sizeof *b.key);
    b.area = malloc((size_t)count * sizeof *b.area);
    int ok = b.order && b.scratch && b.key && b.area;
    for (uint32_t i = 0; ok && i < count; i++) b.order[i] = i;
    if (ok) {
        const part all = {0, count, box_of(&b, 0, count)};
        build(&b, &all, 0, EC_TOP_DEPTH - 1);
        *used = b.used;
    }
    free(b.order);
    free(b.scratch);
    free(b.key);
    free(b.area);
    return ok;
}
