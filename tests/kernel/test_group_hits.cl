/* Groups hits by their triangles' materials. */
#include "order_test.h"
#include "lib/group_hits.h"

#define WAVE 640u
#define PRIMS 100u

static uint scrambled(uint x) { return (x * 747796405u + 2891336453u) >> 16; }
/* Every seventh ray misses; triangle p has material p % materials. */
static void fill(global uint *prims, global uint *hits, uint materials, bool misses)
{
    for (uint p = 0; p < PRIMS; p++) prims[p * EC_PRIM_WORDS + 3] = p % materials;
    for (uint i = 0; i < WAVE; i++) hits[EC_HIT_PRIM * WAVE + i] = misses && scrambled(i) % 7u == 0u ? EC_NO_ID : scrambled(i + WAVE) % PRIMS;
}
static uint group_of(global const uint *hits, uint materials, uint i)
{
    uint prim = hits[EC_HIT_PRIM * WAVE + i];
    return prim == EC_NO_ID ? 31u : prim % materials % 31u;
}

kernel void every_hit_is_there_once_by_groups(global test_result *result, global uint *scratch)
{
    global uint *prims = scratch, *hits = scratch + PRIMS * EC_PRIM_WORDS;
    geometry g = {(global const float *)prims};
    uint order[EC_ORDERED + LANES], groups[WAVE];
    const uint firsts[2] = {0, 320}, counts[4] = {33, 47, 48, 320}, materials[3] = {1, 3, 70};
    for (uint m = 0; m < 3; m++) {
        fill(prims, hits, materials[m], true);
        for (uint i = 0; i < WAVE; i++) groups[i] = group_of(hits, materials[m], i);
        for (uint f = 0; f < 2; f++)
            for (uint c = 0; c < 4; c++) {
                CHECK(group_hits(&g, (global const float *)hits, WAVE, firsts[f], counts[c], order));
                check_order(result, order, groups, firsts[f], counts[c]);
            }
    }
}

kernel void one_group_keeps_its_order(global test_result *result, global uint *scratch)
{
    global uint *prims = scratch, *hits = scratch + PRIMS * EC_PRIM_WORDS;
    geometry g = {(global const float *)prims};
    uint order[EC_ORDERED + LANES];
    fill(prims, hits, 1, false);
    CHECK(!group_hits(&g, (global const float *)hits, WAVE, 0, 320, order));
    hits[EC_HIT_PRIM * WAVE + 100] = EC_NO_ID;
    CHECK(!group_hits(&g, (global const float *)hits, WAVE, 0, 100, order)); /* entries past the end do not count */
    CHECK(group_hits(&g, (global const float *)hits, WAVE, 0, 101, order));
    CHECK_EQUAL(order[99], 99u);
    CHECK_EQUAL(order[100], 100u);
}

kernel void packed_lanes_are_stored_in_order(global test_result *result, global uint *scratch)
{
    const uint masks[5] = {0, 1, 0x8421, 0x7ffe, 0xffff};
    for (uint m = 0; m < 5; m++) {
        uint bits = masks[m] & (uint)((1ul << LANES) - 1ul), to[LANES], n = 0;
        store_packed(to, LANE_NUMBERS + 5u, bits);
        for (uint k = 0; k < LANES; k++)
            if (bits >> k & 1u) {
                CHECK_EQUAL(to[n], k + 5u);
                n++;
            }
        CHECK_EQUAL(or_of_lanes(U(1) << LANE_NUMBERS), (uint)((1ul << LANES) - 1ul));
    }
}
