/* Roulette for throughputs of 2^-126 to 1000: weights stay finite, and no light is gained or lost. */
#include "kernel_test.h"
#include "lib/roulette.h"
#include "lib/sampler.h"

static float first(lane_f v)
{
    float a[16];
    LANE_STORE(v, a);
    return a[0];
}

static void check_survival(global test_result *result, float fixed, float beta)
{
    float survival = first(roulette_survival(F(beta), fixed)), after = first(F(beta) * (1.0f / F(survival)));
    CHECK_FLOATS(survival > 0.0f && survival <= 1.0f, fixed, beta, survival, 0);
    /* The first of the 2^24 numbers that is not below it is the survival probability itself, so the right number of them is below. */
    uint below = convert_uint_rte(survival * 16777216.0f);
    CHECK_FLOATS((float)below * 0x1p-24f == survival && below >= 1u, fixed, beta, survival, 0);
    if (below < 1u << 24) CHECK(!any_lane(to_unit(U(below << 8)) < survival));
    CHECK(all_lanes(to_unit(U((below - 1u) << 8 | 255u)) < survival));
    /* By throughput, no result is brighter than 1, or brighter than its input. */
    CHECK_FLOATS(all_lanes(is_finite_bits(F(after))) && (fixed > 0.0f || after <= max(1.0f, beta / 0.949f)), fixed, beta, survival, after);
}

kernel void weights_stay_finite(global test_result *result)
{
    for (uint bits = 0x00800000u; bits < 0x447a0000u; bits += 0x00012345u) check_survival(result, 0.0f, as_float(bits));
    for (float p = 1.0f; p > 1e-30f; p *= 0.37f) check_survival(result, p, 1.0f);
}
