/* Checks the invariants of a binary tree: it has every triangle once, or in parts whose boxes together cover its own; boxes contain their
 * subtrees; the depth is within the kernels' stack. */
#ifndef EC_TESTS_BVH_CHECK_H
#define EC_TESTS_BVH_CHECK_H

#include <math.h>
#include <stdlib.h>

#include "accel/build_internal.h"

typedef struct bvh_checked {
    const ec_bvh *bvh;
    const float *positions;
    const uint32_t *indices;
    ec_box *seen;       /* by triangle: the box around its references */
    uint32_t next;      /* leaves cover the order from left to right */
    uint32_t visited;
    ec_error *err;
} bvh_checked;

static inline int bvh_inside(const float *point_lo, const float *point_hi, const ec_bvh_build_node *node)
{
    for (int axis = 0; axis < 3; axis++)
        if (point_lo[axis] < node->lo[axis] || point_hi[axis] > node->hi[axis]) return 0;
    return 1;
}

static inline ec_box checked_box(const bvh_checked *c, uint32_t id)
{
    ec_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t corner = 0; corner < 3; corner++)
        for (int axis = 0; axis < 3; axis++) {
            float x = c->positions[3 * (size_t)c->indices[3 * (size_t)id + corner] + (size_t)axis];
            box.lo[axis] = fminf(box.lo[axis], x);
            box.hi[axis] = fmaxf(box.hi[axis], x);
        }
    return box;
}

static inline int bvh_is_unseen(const ec_box *box) { return box->lo[0] > box->hi[0] && box->lo[0] == INFINITY; }

/* Adds a reference to its triangle's box. */
static inline int bvh_see(bvh_checked *c, uint32_t i)
{
    uint32_t id = c->bvh->order[i];
    if (id >= c->bvh->triangle_count) return 0;
    ec_box *seen = &c->seen[id], box = c->bvh->boxes ? c->bvh->boxes[i] : checked_box(c, id);
    if (!c->bvh->boxes && !bvh_is_unseen(seen)) return 0;
    for (int axis = 0; axis < 3; axis++) {
        seen->lo[axis] = fminf(seen->lo[axis], box.lo[axis]);
        seen->hi[axis] = fmaxf(seen->hi[axis], box.hi[axis]);
    }
    return 1;
}

/* Checks that parts together reach as far as the triangle: whatever a plane cuts off is in another reference. */
static inline ec_result bvh_check_seen(const bvh_checked *c)
{
    for (uint32_t id = 0; id < c->bvh->triangle_count; id++) {
        ec_box box = checked_box(c, id);
        for (int axis = 0; axis < 3; axis++)
            if (c->seen[id].lo[axis] != box.lo[axis] || c->seen[id].hi[axis] != box.hi[axis])
                return ec_fail(c->err, "the BVH does not hold all of triangle %u", id);
    }
    return EC_OK;
}

static inline ec_result bvh_check_leaf(bvh_checked *c, uint32_t index)
{
    const ec_bvh_build_node *node = &c->bvh->nodes[index];
    if (node->count > EC_LEAF_MAX) return ec_fail(c->err, "BVH leaf %u holds %u triangles", index, node->count);
    if (node->first != c->next) return ec_fail(c->err, "BVH leaf %u starts at %u, not %u", index, node->first, c->next);
    if (node->count > c->bvh->ref_count - node->first)
        return ec_fail(c->err, "BVH leaf %u ends past the last triangle", index);
    c->next += node->count;
    for (uint32_t i = node->first; i < c->next; i++) {
        uint32_t id = c->bvh->order[i];
        if (!bvh_see(c, i)) return ec_fail(c->err, "BVH leaf %u holds triangle %u, unknown or held already", index, id);
        ec_box box = c->bvh->boxes ? c->bvh->boxes[i] : checked_box(c, id);
        if (!bvh_inside(box.lo, box.hi, node)) return ec_fail(c->err, "triangle %u sticks out of BVH leaf %u", id, index);
    }
    return EC_OK;
}

static inline ec_result bvh_check_node(bvh_checked *c, uint32_t index, uint32_t depth)
{
    const ec_bvh_build_node *node = &c->bvh->nodes[index];
    c->visited++;
    if (depth > EC_DEPTH_MAX) return ec_fail(c->err, "BVH node %u lies deeper than %u", index, EC_DEPTH_MAX);
    if (node->count || !node->left) return bvh_check_leaf(c, index);
    /* Checks that children follow their parents: the tree has no cycles, and sweeps over the array need no stack. */
    if (node->left <= index || node->left + 1 >= c->bvh->node_count)
        return ec_fail(c->err, "BVH node %u has its children at %u", index, node->left);
    for (uint32_t child = node->left; child <= node->left + 1; child++) {
        const ec_bvh_build_node *below = &c->bvh->nodes[child];
        if (!bvh_inside(below->lo, below->hi, node))
            return ec_fail(c->err, "BVH node %u sticks out of its parent %u", child, index);
        EC_TRY(bvh_check_node(c, child, depth + 1));
    }
    return EC_OK;
}

static inline ec_result bvh_check(const ec_bvh *bvh, const float *positions, const uint32_t *indices, ec_error *err)
{
    bvh_checked c = {.bvh = bvh, .positions = positions, .indices = indices, .err = err};
    if (!bvh->node_count || !bvh->nodes || !bvh->order) return ec_fail(err, "the BVH has not been built");
    c.seen = malloc((bvh->triangle_count + 1) * sizeof *c.seen);
    if (!c.seen) return ec_fail(err, "out of memory for checking the BVH");
    for (uint32_t id = 0; id < bvh->triangle_count; id++)
        c.seen[id] = (ec_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    ec_result result = bvh_check_node(&c, 0, 0);
    if (result == EC_OK && c.next != bvh->ref_count)
        result = ec_fail(err, "the BVH's leaves hold %u of %u references", c.next, bvh->ref_count);
    if (result == EC_OK) result = bvh_check_seen(&c);
    if (result == EC_OK && c.visited != bvh->node_count)
        result = ec_fail(err, "%u of %u BVH nodes can be reached", c.visited, bvh->node_count);
    free(c.seen);
    return result;
}

#endif
