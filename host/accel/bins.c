/* Binned surface area heuristic. Wald 2007, "On fast construction of SAH-based bounding volume hierarchies". */
#include "accel/build_internal.h"

ec_binning ec_binning_of(const ec_range *range)
{
    ec_v4 extent = range->centroids.hi - range->centroids.lo;
    ec_v4 scale = ec_v4_all((float)EC_BINS) / extent;
    ec_binning binning;
    binning.origin = range->centroids.lo;
    binning.scale = ec_v4_select(extent > ec_v4_all(0.0f), scale, ec_v4_all(0.0f));
    binning.last = ec_v4_all((float)(EC_BINS - 1));
    return binning;
}

void ec_bins_fill(ec_bins *bins, const ec_binning *binning, const ec_build_prim *prims, uint32_t count)
{
    for (int i = 0; i < EC_BINS; i++) {
        bins->box[i][0] = bins->box[i][1] = bins->box[i][2] = ec_box4_empty();
        bins->count[i] = ec_i4_all(0);
    }
    for (uint32_t i = 0; i < count; i++) {
        ec_v4 lo = ec_prim_lo(&prims[i]), hi = prims[i].hi;
        ec_i4 bin = ec_bin_of(binning, lo + hi);
        ec_box4_grow(&bins->box[bin[0]][0], lo, hi);
        ec_box4_grow(&bins->box[bin[1]][1], lo, hi);
        ec_box4_grow(&bins->box[bin[2]][2], lo, hi);
        bins->count[bin[0]][0]++;
        bins->count[bin[1]][1]++;
        bins->count[bin[2]][2]++;
    }
}

void ec_bins_merge(ec_bins *bins, const ec_bins *more)
{
    for (int i = 0; i < EC_BINS; i++) {
        for (int axis = 0; axis < 3; axis++)
            ec_box4_grow(&bins->box[i][axis], more->box[i][axis].lo, more->box[i][axis].hi);
        bins->count[i] += more->count[i];
    }
}

uint32_t ec_bins_left(const ec_bins *bins, const ec_split *split)
{
    int32_t left = 0;
    for (int i = 0; i < split->bin; i++) left += bins->count[i][split->axis];
    return (uint32_t)left;
}

/* Returns the cost of leaves: the number of blocks that hold count triangles, times the area. */
static ec_v4 leaf_costs(ec_i4 count, ec_v4 area)
{
    ec_i4 blocks = (count + 7) >> 3; /* EC_LEAF_MAX is 8 */
    return __builtin_convertvector(blocks, ec_v4) * ec_v4_all(EC_COST_BLOCK) * area;
}

static ec_box4 union_of(const ec_bins *bins, int axis, int first, int last)
{
    ec_box4 box = ec_box4_empty();
    for (int i = first; i < last; i++) ec_box4_grow(&box, bins->box[i][axis].lo, bins->box[i][axis].hi);
    return box;
}

static void grow_three(ec_box4 box[3], const ec_box4 by[3])
{
    for (int axis = 0; axis < 3; axis++) ec_box4_grow(&box[axis], by[axis].lo, by[axis].hi);
}

/* Weighs every plane on the three axes at a time; a plane with nothing on one side has a cost that is NaN or infinite and never wins. */
static void sweep(const ec_bins *bins, const ec_i4 ends[EC_BINS], ec_v4 scale, ec_v4 *best, ec_i4 *best_bin)
{
    ec_v4 right_cost[EC_BINS];
    ec_box4 box[3] = {ec_box4_empty(), ec_box4_empty(), ec_box4_empty()};
    ec_i4 below = ec_i4_all(0);
    for (int i = EC_BINS - 1; i > 0; i--) {
        grow_three(box, bins->box[i]);
        below += ends[i];
        right_cost[i] = leaf_costs(below, ec_half_areas(box, scale));
    }
    box[0] = box[1] = box[2] = ec_box4_empty();
    below = ec_i4_all(0);
    *best = ec_v4_all(INFINITY);
    *best_bin = ec_i4_all(0);
    for (int i = 1; i < EC_BINS; i++) {
        grow_three(box, bins->box[i - 1]);
        below += bins->count[i - 1];
        ec_v4 cost = leaf_costs(below, ec_half_areas(box, scale)) + right_cost[i];
        ec_i4 better = cost < *best;
        *best = ec_v4_select(better, cost, *best);
        *best_bin = (better & ec_i4_all(i)) | (~better & *best_bin);
    }
}

ec_split ec_bins_split(const ec_bins *bins, const ec_i4 ends[EC_BINS], const ec_range *range)
{
    ec_v4 scale = ec_box4_scale(&range->box), best;
    ec_i4 best_bin;
    sweep(bins, ends, scale, &best, &best_bin);

    ec_box4 parent[3] = {range->box, range->box, range->box};
    float area = ec_half_areas(parent, scale)[0];
    ec_split split = {.cost = INFINITY, .axis = -1};
    split.leaf_cost = leaf_costs(ec_i4_all((int32_t)range->count), ec_v4_all(area))[0];
    split.node_cost = EC_COST_NODE * area;
    for (int axis = 0; axis < 3; axis++) {
        if (!(best[axis] < split.cost)) continue;
        split.cost = best[axis];
        split.axis = axis;
        split.bin = best_bin[axis];
    }
    if (split.axis < 0) return split;
    split.left_count = ec_bins_left(bins, &split);
    split.left = union_of(bins, split.axis, 0, split.bin);
    split.right = union_of(bins, split.axis, split.bin, EC_BINS);
    return split;
}
