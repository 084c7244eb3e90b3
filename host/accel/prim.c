/* Triangles as boxes: loads them, bounds runs of them, deals them to the two sides of a split. */
#include <string.h>

#include "accel/build_internal.h"

static ec_v4 load_vertex(const float *positions, uint32_t vertex)
{
    const float *p = positions + 3 * (size_t)vertex;
    return (ec_v4){p[0], p[1], p[2], 0.0f};
}

void ec_prim_vertices(const float *positions, const uint32_t *indices, uint32_t id, ec_v4 vertices[3])
{
    for (int k = 0; k < 3; k++) vertices[k] = load_vertex(positions, indices[3 * (size_t)id + (size_t)k]);
}

void ec_prims_load(const float *positions, const uint32_t *indices, uint32_t first, uint32_t count, const float *swept,
                   uint32_t swept_count, ec_build_prim *prims, ec_range *bounds)
{
    const ec_box4 none = ec_box4_empty(); /* below it, NaN vertices leave no mark */
    ec_range_clear(bounds);
    for (uint32_t id = first; id < first + count; id++) {
        ec_v4 v[3];
        if (id >= swept_count) {
            ec_prim_vertices(positions, indices, id, v);
        } else {
            const float *box = swept + 6 * (size_t)id;
            v[0] = v[2] = (ec_v4){box[0], box[1], box[2], 0.0f};
            v[1] = (ec_v4){box[3], box[4], box[5], 0.0f};
        }
        /* Adding +0 turns -0 into +0: which of the two a minimum returns would depend on the order of its operands,
         * and with it the tree on the number of threads. */
        ec_v4 lo = ec_v4_min(v[0], ec_v4_min(v[1], ec_v4_min(v[2], none.lo))) + ec_v4_all(0.0f);
        ec_v4 hi = ec_v4_max(v[0], ec_v4_max(v[1], ec_v4_max(v[2], none.hi))) + ec_v4_all(0.0f);
        ec_box4_grow(&bounds->box, lo, hi);
        ec_range_add(bounds, lo, hi);
        prims[id].lo = (ec_v4)((ec_i4)lo | (ec_i4){0, 0, 0, (int32_t)id});
        prims[id].hi = hi;
    }
}

void ec_prims_bound(const ec_build_prim *prims, uint32_t count, ec_range *bounds)
{
    ec_range_clear(bounds);
    for (uint32_t i = 0; i < count; i++) {
        ec_v4 lo = ec_prim_lo(&prims[i]), hi = prims[i].hi;
        ec_box4_grow(&bounds->box, lo, hi);
        ec_range_add(bounds, lo, hi);
    }
}

void ec_prims_partition(const ec_build_prim *prims, uint32_t count, const ec_binning *binning, const ec_split *split,
                        ec_build_prim *left, ec_build_prim *right, ec_range sides[2])
{
    ec_build_prim *target[2] = {left, right};
    for (int side = 0; side < 2; side++) ec_range_clear(&sides[side]);
    for (uint32_t i = 0; i < count; i++) {
        ec_v4 lo = ec_prim_lo(&prims[i]), hi = prims[i].hi;
        /* Indexing instead of branching: the side is a coin toss to the branch predictor. */
        int side = ec_bin_of(binning, lo + hi)[split->axis] >= split->bin;
        *target[side]++ = prims[i];
        ec_range_add(&sides[side], lo, hi);
    }
}

void ec_range_place(const ec_range *range, uint32_t left_count, uint32_t right_count, uint32_t slack, uint32_t buffer,
                    ec_range children[2])
{
    children[0].first = range->first;
    children[0].count = left_count;
    children[0].capacity = left_count + slack;
    children[1].first = range->first + children[0].capacity;
    children[1].count = right_count;
    children[1].capacity = range->capacity - children[0].capacity;
    for (int side = 0; side < 2; side++) {
        ec_range_clear(&children[side]);
        children[side].depth = range->depth + 1;
        children[side].buffer = buffer;
    }
}
