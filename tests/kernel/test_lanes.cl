/* Lane-wide loads, stores, gathers, scatters, compaction; masks. */
#include "kernel_test.h"
#include "lib/lanes.h"

#define ALL ((uint)((1ul << LANES) - 1ul))
#define MASKS (LANES == 16 ? 2048u : 1u << LANES)
#define SENTINEL 0xdeadbeefu

/* Every mask of up to eight lanes; for sixteen lanes 2048 of them, including the empty and the full one. */
static uint mask_number(uint i)
{
    return LANES == 16 ? (i == 0 ? 0u : (i == 1 ? ALL : (i * 40503u) & ALL)) : i;
}
static lane_i mask_of(uint bits) { return ((U(bits) >> LANE_NUMBERS) & 1u) != 0u; }
static uint scrambled(uint x) { return (x * 747796405u + 2891336453u) ^ (x >> 3); }

kernel void masks_have_their_bits(global test_result *result)
{
    for (uint i = 0; i < MASKS; i++) {
        uint bits = mask_number(i), other = mask_number((i * 7u + 3u) % MASKS);
        lane_i m = mask_of(bits), n = mask_of(other);
        CHECK_EQUAL(mask_bits(m), bits);
        CHECK_EQUAL(any_lane(m), bits != 0);
        CHECK_EQUAL(all_lanes(m), bits == ALL);
        CHECK_EQUAL(count_lanes(m), popcount(bits));
        CHECK_EQUAL(mask_bits(!m), ~bits & ALL);
        CHECK_EQUAL(mask_bits(m & n), bits & other);
        CHECK_EQUAL(mask_bits(m | n), bits | other);
        CHECK_EQUAL(mask_bits(m & !n), bits & ~other & ALL);
        CHECK_EQUAL(mask_bits(!!m), bits);
    }
    CHECK(all_lanes(TRUE_MASK));
    CHECK(!any_lane(!TRUE_MASK));
}

kernel void eight_lanes_have_their_bits(global test_result *result)
{
    for (uint bits = 0; bits < 256; bits++) {
        int8 m = (((uint8)(bits) >> (uint8)(0, 1, 2, 3, 4, 5, 6, 7)) & 1u) != 0u;
        CHECK_EQUAL(mask_bits8(m), bits);
    }
}

kernel void comparisons_are_masks(global test_result *result)
{
    volatile float zero = 0.0f;
    lane_f x = to_lane_f(LANE_NUMBERS), nan = F(zero / zero);
    for (uint k = 0; k <= LANES; k++) {
        CHECK_EQUAL(mask_bits(x < (float)k), ALL & ((1u << k) - 1u));
        CHECK_EQUAL(mask_bits(x >= (float)k), ALL & ~((1u << k) - 1u));
        CHECK_EQUAL(mask_bits(LANE_NUMBERS + 0u * U(1) < k), ALL & ((1u << k) - 1u));
    }
    CHECK_EQUAL(mask_bits(nan < 1.0f), 0);
    CHECK_EQUAL(mask_bits(nan >= 1.0f), 0);
    CHECK_EQUAL(mask_bits(nan == nan), 0);
    CHECK_EQUAL(mask_bits(!(nan < 1.0f)), ALL);
    CHECK_EQUAL(mask_bits(F(-0.0f) == F(0.0f)), ALL);
}

kernel void select_takes_a_where_the_mask_is_set(global test_result *result)
{
    volatile float zero = 0.0f;
    for (uint i = 0; i < MASKS; i++) {
        uint bits = mask_number(i), good = 1;
        lane_i m = mask_of(bits);
        float f[16];
        uint u[16];
        int n[16];
        /* Both sides are evaluated; the one that is not chosen has no effect. */
        LANE_STORE(m ? to_lane_f(LANE_NUMBERS) : F(zero / zero), f);
        LANE_STORE(m ? (U(0) + LANE_NUMBERS) : U(100u), u);
        LANE_STORE(m ? I(-1) : I(0x7fffffff), n);
        for (uint k = 0; k < LANES; k++) {
            bool on = (bits >> k) & 1u;
            good &= on ? f[k] == (float)k : (as_uint(f[k]) & 0x7fffffffu) > 0x7f800000u;
            good &= u[k] == (on ? k : 100u);
            good &= n[k] == (on ? -1 : 0x7fffffff);
        }
        CHECK_UINTS(good, bits, 0, 0, 0);
    }
}

kernel void division_is_exact(global test_result *result)
{
    for (uint i = 0; i < 4096; i++) {
        /* Small numbers, powers of two and their neighbours, the largest, random ones. */
        uint d = i < 300 ? i + 1u : i < 396 ? (1u << (i / 3u % 32u)) + i % 3u - 1u : i < 400 ? 0u - (i - 395u) : scrambled(i) >> (i % 31u);
        d = max(d, 1u);
        uint q[16], n[16], good = 1;
        lane_u near = d * (scrambled(i + 77u) / d) + LANE_NUMBERS - LANES / 2u; /* near a multiple, and near 0, where it wraps */
        lane_u numbers = i % 3u ? near : 0u - LANE_NUMBERS * (i % 5u);
        LANE_STORE(numbers, n);
        LANE_STORE(divide(numbers, d), q);
        for (uint k = 0; k < LANES; k++) good &= q[k] == n[k] / d;
        CHECK_UINTS(good, d, n[0], q[0], 0);
    }
}

kernel void conversions(global test_result *result)
{
    int n[16];
    float f[16];
    LANE_STORE(to_lane_i(to_lane_f(LANE_NUMBERS) * -1.75f), n);
    for (int k = 0; k < LANES; k++) CHECK_EQUAL(n[k], -(7 * k / 4)); /* towards zero */
    LANE_STORE(to_lane_f(U(0xffffff00u) - LANE_NUMBERS * 256u), f);
    for (uint k = 0; k < LANES; k++) CHECK_SAME_BITS(f[k], (float)(0xffffff00u - 256u * k));
    LANE_STORE(int_to_lane_f(I(-5) - uint_to_lane_i(U(0) + LANE_NUMBERS)), f);
    for (int k = 0; k < LANES; k++) CHECK_SAME_BITS(f[k], (float)(-5 - k));
    LANE_STORE(as_lane_f(as_lane_u(F(-1.5f)) + LANE_NUMBERS), f);
    for (uint k = 0; k < LANES; k++) CHECK_EQUAL(as_uint(f[k]), as_uint(-1.5f) + k);
}

kernel void loads_and_stores(global test_result *result, global uint *scratch)
{
    for (uint i = 0; i < 256; i++) scratch[i] = scrambled(i);
    for (uint at = 0; at < 20; at++) { /* any alignment of four bytes */
        uint u[16];
        LANE_STORE(LANE_LOAD(scratch + at), u);
        for (uint k = 0; k < LANES; k++) CHECK_EQUAL(u[k], scrambled(at + k));
    }
    for (uint at = 300; at < 320; at++) {
        for (uint i = 280; i < 360; i++) scratch[i] = SENTINEL;
        LANE_STORE(U(7) + LANE_NUMBERS, scratch + at);
        for (uint i = 280; i < 360; i++)
            CHECK_EQUAL(scratch[i], i >= at && i < at + LANES ? 7u + i - at : SENTINEL);
    }
}

constant float table[8] = {0.5f, -1.0f, 2.0f, 3.0f, 5.0f, 7.0f, 11.0f, 13.0f};

kernel void gathers(global test_result *result, global uint *scratch)
{
    for (uint i = 0; i < 1024; i++) scratch[i] = as_uint((float)i + 0.25f);
    for (uint round = 0; round < 64; round++) {
        lane_u index = ((LANE_NUMBERS + round * LANES) * 747796405u + 2891336453u) >> 22; /* 0 ... 1023 */
        index = min(index, U(1020));
        uint at[16], u[16];
        float f[16], a[16], b[16], c[16], d[16], t[16];
        LANE_STORE(index, at);
        LANE_STORE(gather_f((global const float *)scratch, index), f);
        LANE_STORE(gather_u(scratch, index), u);
        LANE_STORE(gather_constant_f(table, index & 7u), t);
        quad q = gather_quad((global const float *)scratch, index);
        LANE_STORE(q.a, a);
        LANE_STORE(q.b, b);
        LANE_STORE(q.c, c);
        LANE_STORE(q.d, d);
        for (uint k = 0; k < LANES; k++) {
            float x = (float)at[k] + 0.25f;
            CHECK_SAME_BITS(f[k], x);
            CHECK_EQUAL(u[k], as_uint(x));
            CHECK_SAME_BITS(t[k], table[at[k] & 7u]);
            CHECK_FLOATS(a[k] == x && b[k] == x + 1.0f && c[k] == x + 2.0f && d[k] == x + 3.0f, a[k], b[k], c[k], d[k]);
        }
    }
}

kernel void scatters_touch_their_lanes_only(global test_result *result, global uint *scratch)
{
    global float *p = (global float *)scratch;
    for (uint i = 0; i < MASKS; i++) {
        uint bits = mask_number(i), good = 1;
        for (uint k = 0; k < 64; k++) p[k] = 1000.0f + k;
        for (uint k = 64; k < 256; k++) p[k] = 2000.0f + k;
        lane_u at = (LANE_NUMBERS * 3u + i) & 63u; /* all lanes differ */
        lane_f x = to_lane_f(U(0) + LANE_NUMBERS);
        scatter_f(p, at, x, bits);
        scatter_add_3(p + 64, 64, at, x + 0.5f, x + 100.0f, -x, bits);
        float set[64], added[192];
        for (uint k = 0; k < 64; k++) set[k] = 1000.0f + k;
        for (uint k = 0; k < 192; k++) added[k] = 2064.0f + k;
        for (uint k = 0; k < LANES; k++) {
            if (!((bits >> k) & 1u)) continue;
            uint to = (k * 3u + i) & 63u;
            set[to] = (float)k;
            added[to] += (float)k + 0.5f;
            added[64 + to] += (float)k + 100.0f;
            added[128 + to] -= (float)k;
        }
        for (uint k = 0; k < 64; k++) good &= p[k] == set[k];
        for (uint k = 0; k < 192; k++) good &= p[64 + k] == added[k];
        CHECK_UINTS(good, bits, 0, 0, 0);
    }
}

kernel void compaction_keeps_order_and_neighbours(global test_result *result, global uint *scratch)
{
    for (uint i = 0; i < MASKS; i++) {
        uint bits = mask_number(i), good = 1, at = 8 + i % 5, n = 0;
        for (uint k = 0; k < 48; k++) scratch[k] = SENTINEL;
        store_compact((global float *)scratch + at, as_lane_f((U(0) + LANE_NUMBERS) * 77u + 5u), bits);
        for (uint k = 0; k < LANES; k++)
            if ((bits >> k) & 1u) good &= scratch[at + n++] == k * 77u + 5u;
        for (uint k = 0; k < 48; k++)
            if (k < at || k >= at + n) good &= scratch[k] == SENTINEL;
        CHECK_UINTS(good, bits, n, 0, 0);
    }
}
