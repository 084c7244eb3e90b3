/* Tests the driver itself, and the arithmetic that every kernel relies on. Operands pass through volatile variables, so that the device
 * computes them and not the compiler. */
#include "kernel_test.h"

kernel void contraction_is_off(global test_result *result) {
    volatile float a = 1.0f + 0x1p-12f, b = 1.0f + 0x1p-12f, c = 1.0f + 0x1p-11f, d = 1.0f;
    float x = a, y = b, z = c, w = d;
    /* x y = 1 + 2^-11 + 2^-24 rounds to z; a fused difference would keep 2^-24. */
    CHECK_SAME_BITS(x * y - z * w, 0.0f);
    CHECK_SAME_BITS(x * y - z, 0.0f);
    CHECK_SAME_BITS(fma(x, y, -z), 0x1p-24f);
    float4 v = (float4)(x), u = v * y - z;
    CHECK_SAME_BITS(u.w, 0.0f);
}

kernel void nan_is_seen_by_its_bits(global test_result *result) {
    volatile float zero = 0.0f;
    float nan = zero / zero, infinite = 1.0f / zero;
    CHECK((as_uint(nan) & 0x7fffffffu) > 0x7f800000u);
    CHECK((as_uint(infinite) & 0x7fffffffu) == 0x7f800000u);
    CHECK(nan != nan);
    CHECK(isnan(nan));
}

#ifdef DENORMALS
kernel void denormals_are_kept(global test_result *result) {
    volatile float smallest = 0x1p-126f, half_ = 0.5f;
    CHECK_SAME_BITS(smallest * half_, 0x1p-127f);
}
#endif

#ifdef CORRECTLY_ROUNDED
/* q is the float nearest to a / b if |a - q b| <= half an ulp of q times b; fma gives a - q b exactly here. */
kernel void divide_is_correctly_rounded(global test_result *result) {
    uint bits = 0x12345u;
    for (int i = 0; i < 2000; i++) {
        bits = bits * 747796405u + 2891336453u;
        volatile float a = as_float(0x3f800000u | (bits >> 9));
        bits = bits * 747796405u + 2891336453u;
        volatile float b = as_float(0x3f800000u | (bits >> 9));
        float q = a / b, ulp = q < 1.0f ? 0x1p-24f : 0x1p-23f;
        CHECK_FLOATS(fabs(fma(-q, b, a)) <= 0.5f * ulp * b, a, b, q, fma(-q, b, a));
    }
}

kernel void sqrt_is_correctly_rounded(global test_result *result) {
    uint bits = 0x12345u;
    for (int i = 0; i < 2000; i++) {
        bits = bits * 747796405u + 2891336453u;
        volatile float a = as_float(0x3f800000u | (bits >> 9));
        float s = sqrt(a);
        /* |s - sqrt(a)| = |s s - a| / (s + sqrt(a)), and s is in [1, 2) where an ulp is 2^-23. */
        CHECK_FLOATS(fabs(fma(s, s, -a)) <= 0x1p-23f * s * (1.0f + 0x1p-22f), a, s, fma(s, s, -a), 0.0f);
    }
}
#endif

/* With -DTEST_MUST_FAIL the driver must count, locate and print these failures; it builds this file once that way. */
#ifdef TEST_MUST_FAIL
kernel void must_fail(global test_result *result) {
    CHECK(1);
#line 1000
    CHECK_NEAR(1.5f, 2.5f, 0.25f);
    CHECK(0);
}
#endif
