/* Vectors, frames, weights. (Accuracy of the transcendental functions: test_reference.c.) */
#include "kernel_test.h"
#include "lib/math.h"
#include "lib/sampler.h"

static float first(lane_f v)
{
    float a[16];
    LANE_STORE(v, a);
    return a[0];
}

kernel void vectors(global test_result *result)
{
    v3 a = v3_make(F(1.0f), F(2.0f), F(-3.0f)), b = v3_make(F(4.0f), F(-5.0f), F(6.0f)), c = v3_cross(a, b);
    CHECK_SAME_BITS(first(v3_dot(a, b)), -24.0f);
    CHECK_SAME_BITS(first(c.x), -3.0f);
    CHECK_SAME_BITS(first(c.y), -18.0f);
    CHECK_SAME_BITS(first(c.z), -13.0f);
    v3 s = v3_fma(b, F(2.0f), a);
    CHECK_FLOATS(first(s.x) == 9.0f && first(s.y) == -8.0f && first(s.z) == 9.0f, first(s.x), first(s.y), first(s.z), 0);
    CHECK_SAME_BITS(first(v3_max_component(b)), 6.0f);
    CHECK_NEAR(first(luminance(v3_splat(F(1.0f)))), 1.0f, 0x1p-23f);
    v3 n = v3_normalize(v3_make(F(3e-3f), F(-4e-3f), F(0.0f)));
    CHECK_NEAR(first(n.x), 0.6f, 0x1p-23f);
    CHECK_NEAR(first(n.y), -0.8f, 0x1p-23f);
}

kernel void finite_is_seen_by_bits(global test_result *result)
{
    volatile float zero = 0.0f, one = 1.0f;
    const float good[6] = {0.0f, -0.0f, 3.4028235e38f, -3.4028235e38f, 1e-45f, 1.0f};
    for (int i = 0; i < 6; i++) CHECK(all_lanes(is_finite_bits(F(good[i]))));
    CHECK(!any_lane(is_finite_bits(F(one / zero))));
    CHECK(!any_lane(is_finite_bits(F(-one / zero))));
    CHECK(!any_lane(is_finite_bits(F(zero / zero))));
    CHECK(!any_lane(is_finite_bits(F(as_float(0x7f800001u)))));
    CHECK(!any_lane(is_finite_bits(F(as_float(0xffffffffu)))));
    v3 v = v3_splat(F(1.0f));
    CHECK(all_lanes(v3_is_finite(v)));
    for (int i = 0; i < 3; i++) {
        v3 w = v3_make(F(i == 0 ? one / zero : one), F(i == 1 ? zero / zero : one), F(i == 2 ? -one / zero : one));
        CHECK(!any_lane(v3_is_finite(w)));
    }
}

#define FOUR_ULP (4.0f * 0x1p-23f)

static void check_frame(global test_result *result, v3 n)
{
    v3 s, t;
    v3_frame(n, &s, &t);
    lane_f worst = fabs(v3_dot(s, t));
    worst = max(worst, max(fabs(v3_dot(s, n)), fabs(v3_dot(t, n))));
    worst = max(worst, max(fabs(v3_dot(s, s) - 1.0f), fabs(v3_dot(t, t) - 1.0f)));
    v3 c = v3_sub(v3_cross(s, t), n); /* right-handed */
    worst = max(worst, max(fabs(c.x), max(fabs(c.y), fabs(c.z))));
    lane_i good = worst <= FOUR_ULP;
    float w[16], x[16], y[16], z[16];
    LANE_STORE(worst, w);
    LANE_STORE(n.x, x);
    LANE_STORE(n.y, y);
    LANE_STORE(n.z, z);
    uint bad = 0;
    for (uint k = 0; k < LANES; k++)
        if (!(w[k] <= FOUR_ULP)) bad = k;
    CHECK_FLOATS(all_lanes(good), w[bad], x[bad], y[bad], z[bad]);
}

kernel void frames_are_orthonormal(global test_result *result)
{
    for (uint i = 0; i < 4096; i += LANES) {
        lane_u h = hash_u(LANE_NUMBERS + i);
        lane_f z = fma(to_unit(h), F(2.0f), F(-1.0f)), cosine, sine = sincos_2pi(to_unit(hash_u(h + 1u)), &cosine);
        lane_f r = sqrt(max(1.0f - z * z, F(0.0f)));
        check_frame(result, v3_normalize(v3_make(r * cosine, r * sine, z)));
        /* Near the poles, down to a distance of 2^-30, and at the equator, where copysign changes. */
        lane_f small = as_lane_f((127u - 30u + (h & 31u)) << 23);
        small = min(small, F(0.5f));
        check_frame(result, v3_normalize(v3_make(small * cosine, small * sine, F(-1.0f))));
        check_frame(result, v3_normalize(v3_make(small * cosine, small * sine, F(1.0f))));
        check_frame(result, v3_normalize(v3_make(cosine, sine, -small)));
        check_frame(result, v3_normalize(v3_make(cosine, sine, small)));
    }
    check_frame(result, v3_make(F(0.0f), F(0.0f), F(-1.0f)));
    check_frame(result, v3_make(F(0.0f), F(0.0f), F(1.0f)));
    check_frame(result, v3_make(F(0.0f), F(0.0f), F(-0x1.fffffep-1f))); /* -1 + an ulp */
    check_frame(result, v3_make(F(0.0f), F(0.0f), F(-0x1.000002p+0f)));
    check_frame(result, v3_make(F(0x1p-12f), F(-0x1p-12f), F(-0x1.fffffep-1f)));
    check_frame(result, v3_make(F(1e-30f), F(1e-30f), F(-1.0f)));
    check_frame(result, v3_make(F(1.0f), F(0.0f), F(0.0f)));
    check_frame(result, v3_make(F(1.0f), F(0.0f), F(-0.0f)));
    check_frame(result, v3_make(F(0.0f), F(-1.0f), F(-0.0f)));
}

kernel void frames_do_not_see_signs_of_zeros(global test_result *result)
{
    volatile float zero = 0.0f;
    v3 s[2], t[2];
    for (int i = 0; i < 2; i++) v3_frame(v3_make(F(0.0f), F(-0x1.fffffep-1f), F(i ? -zero : zero)), &s[i], &t[i]);
    CHECK_SAME_BITS(first(t[0].y), first(t[1].y));
    CHECK(first(t[0].y) != 0.0f);
    for (int i = 0; i < 2; i++) v3_frame(v3_make(F(1.0f), F(0.0f), F(i ? -zero : zero)), &s[i], &t[i]);
    CHECK_SAME_BITS(first(s[0].z), first(s[1].z));
    CHECK_SAME_BITS(first(t[0].y), first(t[1].y));
}

/* w(a, b) + w(b, a) = 1 within 2 ulp for all magnitudes; each is a^2 / (a^2 + b^2) where that can be computed. */
kernel void weights_sum_to_one(global test_result *result)
{
    float decade[61];
    decade[30] = 1.0f;
    for (int i = 1; i <= 30; i++) {
        decade[30 + i] = decade[29 + i] * 10.0f;
        decade[30 - i] = decade[31 - i] * 0.1f;
    }
    for (int i = 0; i < 61; i++)
        for (int j = 0; j < 61; j += LANES) {
            float row[16];
            for (int k = 0; k < LANES; k++) row[k] = decade[min(j + k, 60)] * (1.0f + 0.01f * (float)((i * 7 + j + k) % 90));
            lane_f a = F(decade[i]), b = LANE_LOAD(row), sum = mis_weight(a, b) + mis_weight(b, a);
            float s[16], w[16];
            LANE_STORE(sum, s);
            LANE_STORE(mis_weight(a, b), w);
            for (int k = 0; k < LANES; k++) {
                CHECK_FLOATS(fabs(s[k] - 1.0f) <= 2.0f * 0x1p-23f, s[k], decade[i], row[k], w[k]);
                CHECK_FLOATS(w[k] >= 0.0f && w[k] <= 1.0f, w[k], decade[i], row[k], 0);
                float r = decade[i] / row[k];
                if (r > 1e-15f && r < 1e15f) CHECK_NEAR(w[k], r * r / (1.0f + r * r), 1e-6f * w[k] + 1e-37f);
            }
        }
    volatile float zero = 0.0f;
    CHECK_SAME_BITS(first(mis_weight(F(1.0f / zero), F(1.0f))), 1.0f);
    CHECK_SAME_BITS(first(mis_weight(F(1.0f), F(0.0f))), 1.0f);
    CHECK_SAME_BITS(first(mis_weight(F(0.0f), F(1.0f))), 0.0f);
}
