#include "accel/build_internal.h"
static void sort_axis(const ec_prim *prims, uint32_t count, int axis, uint8_t *order)
{
    float key[64];
    for (uint32_t i = 0; i < count; i++) {
        float c = prims[i].lo[axis] + prims[i].hi[axis];
        uint32_t k = i;
        for (; k > 0 && key[k - 1] > c; k--) { key[k] = key[k - 1]; order[k] = order[k - 1]; }
        key[k] = c; order[k] = (uint8_t)i;
    }
}
ec_split ec_exact_split(const ec_range *range, const ec_prim *prims, ec_prim *to, ec_box4 centroids[2])
{
    uint8_t order[3][64];
    uint32_t n = range->count;
    for (int a = 0; a < 3; a++) sort_axis(prims, n, a, order[a]);
    ec_v4 right_cost[64], scale = ec_box4_scale(&range->box);
    ec_box4 right_box[64][3];
    ec_box4 box[3] = {ec_box4_empty(), ec_box4_empty(), ec_box4_empty()};
    for (uint32_t i = n - 1; i > 0; i--) {
        for (int a = 0; a < 3; a++) { const ec_prim *p = &prims[order[a][i]]; ec_box4_grow(&box[a], ec_prim_lo(p), p->hi); right_box[i][a]=box[a]; }
        right_cost[i] = ec_leaf_costs(ec_i4_all((int)(n - i)), ec_half_areas(box, scale));
    }
    box[0] = box[1] = box[2] = ec_box4_empty();
    ec_split split = {.cost = INFINITY, .axis = -1};
    for (uint32_t i = 1; i < n; i++) {
        for (int a = 0; a < 3; a++) { const ec_prim *p = &prims[order[a][i-1]]; ec_box4_grow(&box[a], ec_prim_lo(p), p->hi); }
        ec_v4 cost = ec_leaf_costs(ec_i4_all((int)i), ec_half_areas(box, scale)) + right_cost[i];
        for (int a = 0; a < 3; a++) if (cost[a] < split.cost) { split.cost = cost[a]; split.axis = a; split.left_count = i; split.left = box[a]; split.right = right_box[i][a]; }
    }
    ec_box4 parent[3] = {range->box, range->box, range->box};
    float area = ec_half_areas(parent, scale)[0];
    split.leaf_cost = ec_leaf_costs(ec_i4_all((int)n), ec_v4_all(area))[0];
    if (n <= EC_LEAF_MAX && !(split.cost + area < split.leaf_cost)) { split.axis = -2; return split; }
    if (split.axis < 0) return split;
    uint32_t larger = split.left_count > n / 2 ? split.left_count : n - split.left_count;
    if (!ec_depth_allows(range->depth + 1, larger)) { split.axis = -1; return split; }
    centroids[0] = centroids[1] = ec_box4_empty();
    for (uint32_t i = 0; i < n; i++) {
        to[i] = prims[order[split.axis][i]];
        ec_v4 c = ec_prim_lo(&to[i]) + to[i].hi;
        ec_box4_grow(&centroids[i >= split.left_count], c, c);
    }
    return split;
}
