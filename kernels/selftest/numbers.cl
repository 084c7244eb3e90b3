/* Arithmetic, the renderer's own functions and its random numbers over arrays: shared/selftest.h says which function is which. */
#include "../lib/elementary.h"
#include "../lib/sampler.h"
#include "../shared/selftest.h"

EC_FN lane_f compared(lane_f a, lane_f b)
{
    return (a < b ? F(1.0f) : F(0.0f)) + (a > b ? F(2.0f) : F(0.0f)) + (a == b ? F(4.0f) : F(0.0f)) + (a != b ? F(8.0f) : F(0.0f));
}

EC_FN lane_f value_of(uint function, lane_f a, lane_f b, lane_f c)
{
    lane_f cosine, sine;
    switch (function) {
    case EC_NUMBERS_DIVIDE: return a / b;
    case EC_NUMBERS_SQRT: return sqrt(a);
    case EC_NUMBERS_FMA: return fma(a, b, -c);
    case EC_NUMBERS_LESS: return a * b - c;
    case EC_NUMBERS_SIN: return sincos_2pi(a, &cosine);
    case EC_NUMBERS_COS: sine = sincos_2pi(a, &cosine); return cosine;
    case EC_NUMBERS_EXP: return exp_negative(a);
    case EC_NUMBERS_LOG: return log_unit(a, 1.0f - a);
    case EC_NUMBERS_ATAN2: return atan2_over_2pi(a, b);
    case EC_NUMBERS_IS_FINITE: return is_finite_bits(a) ? F(1.0f) : F(0.0f);
    case EC_NUMBERS_COMPARED: return compared(a, b);
    case EC_NUMBERS_ADD: return a + b;
    }
    return F(0.0f);
}

kernel void ec_numbers(uint n, uint function, global const float *a, global const float *b, global const float *c,
                       global float *out)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    LANE_STORE(value_of(function, LANE_LOAD(a + at), LANE_LOAD(b + at), LANE_LOAD(c + at)), out + at);
}

/* Pairs of random integers. */
kernel void ec_random(uint n, uint seed, global const uint *pixel, global const uint *index, uint pair, global uint *out)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    lane_u a, b;
    sample_pair_u(sampler_make(seed, LANE_LOAD(pixel + at), LANE_LOAD(index + at)), pair, &a, &b);
    LANE_STORE(a, out + at);
    LANE_STORE(b, out + n + at);
}
