/* Order of slots and pixels: tiles of 8 x 8, cut at the edges. */
#include "kernel_test.h"
#include "lib/film.h"

#define SIZES 7u
constant ec_params sizes[SIZES] = {{.width = 1, .height = 1, .batch = 1},   {.width = 8, .height = 8, .batch = 2, .first_sample = 6},
                                   {.width = 9, .height = 17, .batch = 3},  {.width = 7, .height = 30, .batch = 5},
                                   {.width = 33, .height = 3, .batch = 16}, {.width = 24, .height = 9, .batch = 7},
                                   {.width = 26, .height = 23, .batch = 1}};

static lane_u place(constant ec_params *p, lane_u pixel)
{
    lane_u x, y;
    pixel_to_xy(p, pixel, &x, &y);
    return y * p->width + x;
}

kernel void every_pixel_is_there_once(global test_result *result, global uint *scratch)
{
    for (uint s = 0; s < SIZES; s++) {
        constant ec_params *p = &sizes[s];
        uint count = p->width * p->height, at[16], again[16], once = 1;
        for (uint i = 0; i < count; i++) scratch[i] = 0;
        for (uint i = 0; i < count; i += LANES) {
            LANE_STORE(place(p, LANE_NUMBERS + i), at);
            LANE_STORE(place(p, LANE_NUMBERS + (i + 1000u * count)), again);
            for (uint k = 0; k < LANES && i + k < count; k++) {
                CHECK_EQUAL(again[k], at[k]);
                CHECK(at[k] < count);
                scratch[min(at[k], count - 1u)]++;
            }
        }
        for (uint i = 0; i < count; i++) once &= scratch[i] == 1;
        CHECK_UINTS(once, p->width, p->height, s, 0);
    }
}

kernel void tiles_follow_one_another(global test_result *result)
{
    const uint pixels[5] = {0, 1, 8, 64, 26 * 8}, x[5] = {0, 1, 0, 8, 0}, y[5] = {0, 0, 1, 0, 8};
    for (uint k = 0; k < 5; k++) {
        uint at[16];
        LANE_STORE(place(&sizes[6], U(pixels[k])), at);
        for (uint l = 0; l < LANES; l++) CHECK_EQUAL(at[l], y[k] * 26u + x[k]);
    }
}

kernel void a_slot_is_a_sample_of_a_pixel(global test_result *result, global uint *scratch)
{
    for (uint s = 0; s < SIZES; s++)
        for (uint i = 0; i < 400; i += LANES) {
            uint pixels[16], samples[16];
            lane_u pixel, sample;
            slot_to_pixel(&sizes[s], 5, 0, LANE_NUMBERS + i, &pixel, &sample);
            LANE_STORE(pixel, pixels);
            LANE_STORE(sample, samples);
            for (uint k = 0; k < LANES; k++) {
                CHECK_EQUAL(pixels[k], 5u + (i + k) / sizes[s].batch);
                CHECK_EQUAL(samples[k], sizes[s].first_sample + (i + k) % sizes[s].batch);
            }
        }
}

/* Entry i is pixel 1000 - 3 i, which has 7 i samples. */
kernel void a_list_says_which_pixel_and_sample(global test_result *result, global uint *scratch)
{
    const uint first = 20, most = 200;
    for (uint i = 0; i < most; i++) {
        scratch[EC_LIST_WORDS * i] = 1000 - 3 * i;
        scratch[EC_LIST_WORDS * i + 1] = 7 * i;
    }
    for (uint s = 0; s < SIZES; s++)
        for (uint i = 0; i < 128; i += LANES) {
            uint pixels[16], samples[16];
            lane_u pixel, sample;
            slot_to_pixel(&sizes[s], first, scratch, LANE_NUMBERS + i, &pixel, &sample);
            LANE_STORE(pixel, pixels);
            LANE_STORE(sample, samples);
            for (uint k = 0; k < LANES; k++) {
                const uint entry = first + (i + k) / sizes[s].batch;
                CHECK_EQUAL(pixels[k], 1000 - 3 * entry);
                CHECK_EQUAL(samples[k], sizes[s].first_sample + 7 * entry + (i + k) % sizes[s].batch);
            }
        }
}
