/* Triangles as boxes: loading them, bounding a run of them, dealing them to the two sides of a split. */
#include <string.h>

#include "accel/build_internal.h"

static ec_v4 load_vertex(const float *positions, uint32_t vertex)
{
    const float *p = positions + 3 * (size_t)vertex;
    return (ec_v4){p[0], p[1], p[2], 0.0f};
}

void ec_prims_load(const float *positions, const uint32_t *indices, uint32_t first, uint32_t count, ec_prim *prims,
                   ec_range *bounds)
{
    const ec_box4 none = ec_box4_empty(); /* below it, NaN vertices leave no mark */
    ec_box4 box = none, centroids = none;
    for (uint32_t id = first; id < first + count; id++) {
        const uint32_t *corner = indices + 3 * (size_t)id;
        ec_v4 a = load_vertex(positions, corner[0]), b = load_vertex(positions, corner[1]);
        ec_v4 c = load_vertex(positions, corner[2]);
        /* Adding +0 turns -0 into +0: which of the two a minimum returns would depend on the order of its operands,
         * and with it the tree on the number of threads. */
        ec_v4 lo = ec_v4_min(a, ec_v4_min(b, ec_v4_min(c, none.lo))) + ec_v4_all(0.0f);
        ec_v4 hi = ec_v4_max(a, ec_v4_max(b, ec_v4_max(c, none.hi))) + ec_v4_all(0.0f);
        ec_box4_grow(&box, lo, hi);
        ec_box4_grow(&centroids, lo + hi, lo + hi);
        prims[id].lo = (ec_v4)((ec_i4)lo | (ec_i4){0, 0, 0, (int32_t)id});
        prims[id].hi = hi;
    }
    bounds->box = box;
    bounds->centroids = centroids;
}

void ec_prims_bound(const ec_prim *prims, uint32_t count, ec_range *bounds)
{
    ec_box4 box = ec_box4_empty(), centroids = ec_box4_empty();
    for (uint32_t i = 0; i < count; i++) {
        ec_v4 lo = ec_prim_lo(&prims[i]), hi = prims[i].hi;
        ec_box4_grow(&box, lo, hi);
        ec_box4_grow(&centroids, lo + hi, lo + hi);
    }
    bounds->box = box;
    bounds->centroids = centroids;
}

void ec_prims_partition(const ec_prim *prims, uint32_t count, const ec_binning *binning, const ec_split *split,
                        ec_prim *left, ec_prim *right, ec_box4 centroids[2])
{
    ec_prim *target[2] = {left, right};
    centroids[0] = centroids[1] = ec_box4_empty();
    for (uint32_t i = 0; i < count; i++) {
        ec_v4 centroid = ec_prim_lo(&prims[i]) + prims[i].hi;
        /* Indexing instead of branching: the side is a coin toss to the branch predictor. */
        int side = ec_bin_of(binning, centroid)[split->axis] >= split->bin;
        *target[side]++ = prims[i];
        ec_box4_grow(&centroids[side], centroid, centroid);
    }
}
