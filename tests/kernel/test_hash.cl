/* The integer functions of the samplers: known values, computed in Python, and their defining properties. */
#include "kernel_test.h"
#include "lib/sampler.h"

static uint first(lane_u v)
{
    uint a[16];
    LANE_STORE(v, a);
    return a[0];
}

kernel void hash_gives_known_values(global test_result *result)
{
    const uint in[7] = {0u, 1u, 2u, 0x12345678u, 0x80000000u, 0xffffffffu, 0xdeadbeefu};
    const uint out[7] = {0u, 0x86d2fa73u, 0xda7f4e7u, 0x16e776bdu, 0xe0bd5472u, 0x99b5e683u, 0x2a2acaf2u};
    for (int i = 0; i < 7; i++) {
        CHECK_EQUAL(first(hash_u(U(in[i]))), out[i]);
        CHECK_EQUAL(hash_scalar(in[i]), out[i]);
    }
    uint lanes[16];
    LANE_STORE(hash_u(LANE_NUMBERS + 41u * U(1)), lanes);
    for (uint k = 0; k < LANES; k++) CHECK_EQUAL(lanes[k], hash_scalar(41u + k));
}

kernel void scrambling_gives_known_values(global test_result *result)
{
    const uint in[5] = {0u, 1u, 0x80000000u, 0xdeadbeefu, 0xffffffffu};
    const uint seed[5] = {0u, 0x9e3779b9u, 1u, 0x12345678u, 0xffffffffu};
    const uint out[5] = {0u, 0xf28cd7c4u, 0x3c7f85abu, 0xabdb6de7u, 0x5edbfd28u};
    for (int i = 0; i < 5; i++) CHECK_EQUAL(first(owen_reversed(U(in[i]), U(seed[i]))), out[i]);
}

/* Owen scrambling: bit b of the result is bit b of x, possibly flipped, depending only on the bits below it. */
kernel void scrambling_is_nested(global test_result *result)
{
    for (uint i = 0; i < 256; i++) {
        uint x = hash_scalar(i), seed = hash_scalar(i + 1000u), y = first(owen_reversed(U(x), U(seed)));
        for (uint b = 0; b < 32; b++) {
            uint z = first(owen_reversed(U(x ^ (1u << b)), U(seed)));
            CHECK_UINTS(((y ^ z) & ((2u << b) - 1u)) == 1u << b, x, b, y, z);
        }
    }
}

kernel void unit_is_never_one(global test_result *result)
{
    for (uint i = 0; i < 256; i++) {
        float a[16];
        LANE_STORE(to_unit(U(0xffffff00u + i)), a);
        CHECK_FLOATS(a[0] < 1.0f && a[0] == 1.0f - 0x1p-24f, a[0], 0.0f, 0.0f, 0.0f);
        LANE_STORE(to_unit(U(i)), a);
        CHECK_SAME_BITS(a[0], 0.0f);
    }
    float a[16];
    LANE_STORE(to_unit(U(0x80000000u)), a);
    CHECK_SAME_BITS(a[0], 0.5f);
}

kernel void bits_are_reversed(global test_result *result)
{
    for (uint i = 0; i < 200; i++) {
        uint x = i < 32 ? 1u << i : hash_scalar(i), y = 0;
        for (uint b = 0; b < 32; b++) y |= ((x >> b) & 1u) << (31u - b);
        CHECK_EQUAL(first(reverse_bits(U(x))), y);
    }
}

/* Against direction numbers: v_0 = 1/2, v_k = v_(k-1) xor v_(k-1) / 2 (Sobol's second dimension, polynomial x + 1). */
kernel void sobol_is_sobol(global test_result *result)
{
    uint v[32];
    v[0] = 0x80000000u;
    for (int k = 1; k < 32; k++) v[k] = v[k - 1] ^ (v[k - 1] >> 1);
    for (uint i = 0; i < 600; i++) {
        uint index = i < 400 ? i : hash_scalar(i), x = 0;
        for (uint b = 0; b < 32; b++)
            if ((index >> b) & 1u) x ^= v[b];
        uint lanes[16], order[16];
        LANE_STORE(reverse_bits(sobol_second_reversed(U(index) + LANE_NUMBERS * 0u)), lanes);
        LANE_STORE(sobol_second_reversed(U(index)), order);
        CHECK_EQUAL(lanes[0], x);
        CHECK_EQUAL(lanes[LANES - 1], x);
        CHECK_EQUAL(first(reverse_bits(U(order[0]))), x);
    }
}
