/* Sorts rays by octants of their origins and directions. */
#include "order_test.h"
#include "lib/sort_rays.h"

#define WAVE 640u
#define PART (WAVE / 2u)

static uint scrambled(uint x) { return (x * 747796405u + 2891336453u) ^ (x >> 3); }

/* Six fields of numbers of both signs, in steps that fill all bins unevenly. */
static void fill(global float *queue)
{
    for (uint i = 0; i < 6 * WAVE; i++) queue[i] = (float)(scrambled(i) >> 8) * 0x1p-24f - 0.4f;
}
static uint sign(global const float *queue, uint field, uint i) { return queue[field * WAVE + i] < 0.0f; }
/* The expected Gray code of the bin. */
static uint signs(global const float *queue, uint i)
{
    uint bits = 0;
    for (uint k = 0; k < 3; k++) bits |= sign(queue, k, i) << (3 + k) | sign(queue, 3 + k, i) << k;
    return bits;
}
static uint bin_of(uint gray)
{
    uint bin = 0;
    for (; gray; gray >>= 1) bin ^= gray;
    return bin;
}

kernel void every_ray_is_there_once_by_bins(global test_result *result, global uint *scratch)
{
    global float *queue = (global float *)scratch;
    uint order[EC_ORDERED], bins[WAVE];
    fill(queue);
    for (uint i = 0; i < WAVE; i++) bins[i] = bin_of(signs(queue, i));
    const uint firsts[2] = {0, PART}, counts[5] = {1, 15, 16, 17, PART};
    for (uint f = 0; f < 2; f++)
        for (uint c = 0; c < 5; c++) {
            sort_rays(queue, WAVE, 0, 3, firsts[f], counts[c], order);
            check_order(result, order, bins, firsts[f], counts[c]);
        }
}

kernel void work_items_share_a_part(global test_result *result, global uint *scratch)
{
    global float *queue = (global float *)scratch;
    global uint *ends = scratch + 6 * WAVE;
    uint order[EC_ORDERED], sorted = 0, plain = 0;
    fill(queue);
    ends[0] = 77;
    ends[EC_PART_STRIDE] = PART;
    CHECK_EQUAL(queue_entries(ends, WAVE, PART, 0, WAVE), 0u);
    for (uint i = 0; i < WAVE; i += LANES) {
        uint left = queue_entries(ends, WAVE, PART, i / PART, i);
        plain += left ? item_rays(left, queue, WAVE, PART, 0, 3, i, false, order) : 0;
        uint count = left ? item_rays(left, queue, WAVE, PART, 0, 3, i, true, order) : 0;
        CHECK(count == 0 || i % PART == 0);
        sorted += count;
    }
    CHECK_EQUAL(plain, 77u + PART);
    CHECK_EQUAL(sorted, 77u + PART);
}

/* Launches have a few work-items more for each part than it has entries; the additional ones must not touch a queue or slots. */
kernel void work_items_begin_at_every_entry_once(global test_result *result, global uint *scratch)
{
    global uint *ends = scratch;
    ends[0] = ends[EC_PART_STRIDE] = PART;
    for (uint takes = 1; takes <= 64; takes *= 4) {
        uint next = 0;
        for (uint row = 0; row < 2; row++)
            for (uint item = 0; item < (PART + takes - 1) / takes + 3; item++) {
                uint i = queue_entry(PART, row, item, takes), left = slot_entries(WAVE, i);
                CHECK_EQUAL(min(queue_entries(ends, WAVE, PART, row, i), 1u), min(left, 1u));
                if (!left) continue;
                CHECK_EQUAL(i, next);
                next = min(next + takes, (row + 1) * PART);
            }
        CHECK_EQUAL(next, WAVE);
    }
}
