/* Lamps chosen by the light tree, and their probabilities, for test_light_tree.c. */
#include "lib/light_tree.h"

static v3 point(global const float *points, uint which) { return v3_make(F(points[3 * which]), F(points[3 * which + 1]), F(points[3 * which + 2])); }

/* Probability of each trail, seen from a point. */
kernel void probabilities(uint n, global const float *table, global const float *tree, global const uint *trails, global const float *points, uint which,
                          uint numbers, global float *out)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    const lights l = {.table = table, .tree = tree};
    LANE_STORE(light_tree_pmf(&l, TRUE_MASK, point(points, which), numbers, LANE_LOAD(trails + at)), out + at);
}

/* For hashed `numbers`: the lamp, its probability, that of its trail, and the rescaled number. */
kernel void choices(uint n, uint seed, global const float *table, global const float *tree, global const uint *trails, global const float *points, uint which,
                    uint numbers, global uint *lamps, global float *out)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    const lights l = {.table = table, .tree = tree};
    v3 p = point(points, which);
    lane_f pmf, left;
    lane_u r = hash_u(hash_u(LANE_NUMBERS + at) ^ seed), lamp = light_tree_choose(&l, TRUE_MASK, p, mul_hi(r, U(numbers)), numbers, r, &pmf, &left);
    LANE_STORE(lamp, lamps + at);
    LANE_STORE(pmf, out + at);
    LANE_STORE(light_tree_pmf(&l, TRUE_MASK, p, numbers, gather_u(trails, lamp)), out + n + at);
    LANE_STORE(left, out + 2 * n + at);
}
