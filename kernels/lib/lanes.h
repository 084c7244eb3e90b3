/* Lane-wide arithmetic: one work-item carries LANES paths in OpenCL vector types. With LANES 1 everything below is plain
 * scalar code, which is what a GPU wants; on a CPU LANES is the native vector width.
 *
 * Masks are lane_i: 0 is false; true is -1 in vectors and 1 in scalars, as OpenCL's comparisons give it. Combine masks with
 * & and |, negate them with !, choose with `mask ? a : b` (element-wise on vectors, both sides evaluated). */
#ifndef EC_LIB_LANES_H
#define EC_LIB_LANES_H

#include "../shared/types.h"
#include "packed_lanes.h"

#ifndef LANES
#define LANES 1
#endif

#define EC_CAT_(a, b) a##b
#define EC_CAT(a, b) EC_CAT_(a, b)

#if LANES == 1
typedef float lane_f;
typedef int lane_i;
typedef uint lane_u;
#define LANE(v, k) (v)
#define EACH_LANE(M) M(0)
#define LANE_NUMBERS 0u
#define LANE_LOAD(p) (*(p))
#define LANE_STORE(v, p) (*(p) = (v))
#define LANE_AS(type, v) EC_CAT(as_, type)(v)
#define LANE_CONVERT(type, v) EC_CAT(convert_, type)(v)
#else
typedef EC_CAT(float, LANES) lane_f;
typedef EC_CAT(int, LANES) lane_i;
typedef EC_CAT(uint, LANES) lane_u;
#define LANE(v, k) (v).s##k
#define LANE_LOAD(p) EC_CAT(vload, LANES)(0, p)
#define LANE_STORE(v, p) EC_CAT(vstore, LANES)(v, 0, p)
#define LANE_AS(type, v) EC_CAT(EC_CAT(as_, type), LANES)(v)
#define LANE_CONVERT(type, v) EC_CAT(EC_CAT(convert_, type), LANES)(v)
#if LANES == 4
#define EACH_LANE(M) M(0) M(1) M(2) M(3)
#define LANE_NUMBERS (uint4)(0, 1, 2, 3)
#elif LANES == 8
#define EACH_LANE(M) M(0) M(1) M(2) M(3) M(4) M(5) M(6) M(7)
#define LANE_NUMBERS (uint8)(0, 1, 2, 3, 4, 5, 6, 7)
#elif LANES == 16
#define EACH_LANE(M) M(0) M(1) M(2) M(3) M(4) M(5) M(6) M(7) M(8) M(9) M(a) M(b) M(c) M(d) M(e) M(f)
#define LANE_NUMBERS (uint16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#else
#error "LANES must be 1, 4, 8 or 16"
#endif
#endif

/* Vectors in memory with the alignment of a word. To PoCL's compiler a vload is a call until late: kernels with hundreds of them ran up to 4 % longer
 * and compiled up to 15 % longer. */
typedef lane_f lane_f_words __attribute__((aligned(4)));
typedef float4 float4_words __attribute__((aligned(4)));
typedef uint2 uint2_words __attribute__((aligned(4)));

#define F(x) ((lane_f)(x))
#define I(x) ((lane_i)(x))
#define U(x) ((lane_u)(x))
#define TRUE_MASK (F(0.0f) == F(0.0f))

EC_FN lane_f as_lane_f(lane_u v) { return LANE_AS(float, v); }
EC_FN lane_u as_lane_u(lane_f v) { return LANE_AS(uint, v); }
EC_FN lane_f to_lane_f(lane_u v) { return LANE_CONVERT(float, v); }
EC_FN lane_f int_to_lane_f(lane_i v) { return LANE_CONVERT(float, v); }
EC_FN lane_i to_lane_i(lane_f v) { return LANE_CONVERT(int, v); } /* towards zero */
EC_FN lane_u int_to_lane_u(lane_i v) { return LANE_AS(uint, v); }
EC_FN lane_i uint_to_lane_i(lane_u v) { return LANE_AS(int, v); }

/* Returns one bit per lane, by the sign-bit instruction where there is one: every branch goes through this. */
EC_FN uint mask_bits8(int8 m)
{
#if defined(__AVX__) && __has_builtin(__builtin_ia32_movmskps256)
    return (uint)__builtin_ia32_movmskps256(as_float8(m));
#else
    int8 v = m & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
    int4 a = v.lo | v.hi;
    int2 b = a.lo | a.hi;
    return (uint)(b.x | b.y);
#endif
}

EC_FN uint mask_bits(lane_i m)
{
#if LANES == 1
    return m != 0;
#elif LANES == 4
#if defined(__SSE__) && __has_builtin(__builtin_ia32_movmskps)
    return (uint)__builtin_ia32_movmskps(as_float4(m));
#else
    int4 v = m & (int4)(1, 2, 4, 8);
    int2 b = v.lo | v.hi;
    return (uint)(b.x | b.y);
#endif
#elif LANES == 8
    return mask_bits8(m);
#else
#if defined(__AVX512DQ__) && __has_builtin(__builtin_ia32_cvtd2mask512)
    return (uint)__builtin_ia32_cvtd2mask512(m);
#else
    return mask_bits8(m.lo) | mask_bits8(m.hi) << 8;
#endif
#endif
}

EC_FN bool any_lane(lane_i m) { return mask_bits(m) != 0u; }
EC_FN bool all_lanes(lane_i m) { return mask_bits(m) == (uint)((1ul << LANES) - 1ul); }
EC_FN uint count_lanes(lane_i m) { return popcount(mask_bits(m)); }

/* Returns n / d for a d that all lanes share, by a product (Granlund and Montgomery 1994, figure 4.1), since CPUs have no division of integer vectors. */
EC_FN lane_u divide(lane_u n, uint d)
{
#if LANES == 1
    return n / d;
#else
    if (d == 1u) return n;
    uint bits = 32u - clz(d - 1u);
    lane_u t = mul_hi(n, U((uint)((((1ul << bits) - d) << 32) / d) + 1u));
    return (t + ((n - t) >> 1)) >> (bits - 1u);
#endif
}

/* Gathers: element i of each lane. Lanes that are off must hold an index that may be read. */
EC_FN lane_f gather_f(global const float *restrict p, lane_u i)
{
    lane_f r;
#define GATHER_ONE(k) LANE(r, k) = p[LANE(i, k)];
    EACH_LANE(GATHER_ONE)
    return r;
}

EC_FN lane_u gather_u(global const uint *restrict p, lane_u i)
{
    lane_u r;
    EACH_LANE(GATHER_ONE)
    return r;
}

EC_FN lane_f gather_constant_f(constant float *p, lane_u i)
{
    lane_f r;
    EACH_LANE(GATHER_ONE)
    return r;
#undef GATHER_ONE
}

/* Four consecutive words at p + i of each lane. As 16-byte loads and a transposition in registers this costs a tenth of
 * four gathers on CPUs, whose gather instructions are slow, so records are laid out in fours. */
typedef struct quad {
    lane_f a, b, c, d;
} quad;

#if LANES > 4 && __has_builtin(__builtin_shufflevector)
#define QUAD(k) (*(global const float4_words *)(p + i.s##k))
#if LANES == 16
#define QUAD_ROWS(k, l, m, n) (lane_f)(QUAD(k), QUAD(l), QUAD(m), QUAD(n))
#define QUAD_LOAD                                                                                  \
    lane_f r0 = QUAD_ROWS(0, 4, 8, c), r1 = QUAD_ROWS(1, 5, 9, d), r2 = QUAD_ROWS(2, 6, a, e), r3 = QUAD_ROWS(3, 7, b, f)
#define QUAD_LOW 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29
#define QUAD_HIGH 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31
#define QUAD_FIRST 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29
#define QUAD_SECOND 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31
#else
#define QUAD_ROWS(k, l) (lane_f)(QUAD(k), QUAD(l))
#define QUAD_LOAD lane_f r0 = QUAD_ROWS(0, 4), r1 = QUAD_ROWS(1, 5), r2 = QUAD_ROWS(2, 6), r3 = QUAD_ROWS(3, 7)
#define QUAD_LOW 0, 8, 1, 9, 4, 12, 5, 13
#define QUAD_HIGH 2, 10, 3, 11, 6, 14, 7, 15
#define QUAD_FIRST 0, 1, 8, 9, 4, 5, 12, 13
#define QUAD_SECOND 2, 3, 10, 11, 6, 7, 14, 15
#endif
EC_FN quad gather_quad(global const float *restrict p, lane_u i)
{
    QUAD_LOAD; /* 16 bytes of lane k in row k % 4 */
    lane_f low01 = __builtin_shufflevector(r0, r1, QUAD_LOW), low23 = __builtin_shufflevector(r2, r3, QUAD_LOW);
    lane_f high01 = __builtin_shufflevector(r0, r1, QUAD_HIGH), high23 = __builtin_shufflevector(r2, r3, QUAD_HIGH);
    quad q = {__builtin_shufflevector(low01, low23, QUAD_FIRST), __builtin_shufflevector(low01, low23, QUAD_SECOND),
              __builtin_shufflevector(high01, high23, QUAD_FIRST), __builtin_shufflevector(high01, high23, QUAD_SECOND)};
    return q;
}
#else
EC_FN quad gather_quad(global const float *restrict p, lane_u i)
{
    quad q = {gather_f(p, i), gather_f(p, i + 1u), gather_f(p, i + 2u), gather_f(p, i + 3u)};
    return q;
}
#endif

/* Returns whether v is the same on all lanes, so that one load serves them; false with one lane. */
EC_FN bool all_same(lane_u v) { return LANES > 1 && all_lanes(v == LANE(v, 0)); }
EC_FN quad gather_quad_if(bool is_same, global const float *restrict p, lane_u i)
{
    if (!is_same) return gather_quad(p, i);
    float4 v = *(global const float4_words *)(p + LANE(i, 0));
    quad q = {F(v.x), F(v.y), F(v.z), F(v.w)};
    return q;
}

/* Two consecutive words at p + i of each lane. */
typedef struct pair {
    lane_u a, b;
} pair;

#if LANES > 4 && __has_builtin(__builtin_shufflevector)
#define PAIR(k) (*(global const uint2_words *)(p + i.s##k))
#if LANES == 16
#define PAIR_LOAD                                                                                  \
    lane_u r0 = (lane_u)(PAIR(0), PAIR(1), PAIR(2), PAIR(3), PAIR(4), PAIR(5), PAIR(6), PAIR(7)),  \
           r1 = (lane_u)(PAIR(8), PAIR(9), PAIR(a), PAIR(b), PAIR(c), PAIR(d), PAIR(e), PAIR(f))
#define PAIR_EVEN 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30
#define PAIR_ODD 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31
#else
#define PAIR_LOAD lane_u r0 = (lane_u)(PAIR(0), PAIR(1), PAIR(2), PAIR(3)), r1 = (lane_u)(PAIR(4), PAIR(5), PAIR(6), PAIR(7))
#define PAIR_EVEN 0, 2, 4, 6, 8, 10, 12, 14
#define PAIR_ODD 1, 3, 5, 7, 9, 11, 13, 15
#endif
EC_FN pair gather_pair(global const uint *restrict p, lane_u i)
{
    PAIR_LOAD;
    pair r = {__builtin_shufflevector(r0, r1, PAIR_EVEN), __builtin_shufflevector(r0, r1, PAIR_ODD)};
    return r;
}
#else
EC_FN pair gather_pair(global const uint *restrict p, lane_u i)
{
    pair r = {gather_u(p, i), gather_u(p, i + 1u)};
    return r;
}
#endif

/* Adds x, y, z to p[i], p[i + stride], p[i + 2 stride] on the lanes of `bits`, of which no two may share an index. Goes through memory in a loop over
 * the lanes that are on: a branch per lane would be mispredicted half the time. */
EC_FN void scatter_add_3(global float *restrict p, uint stride, lane_u i, lane_f x, lane_f y, lane_f z, uint bits)
{
    uint at[LANES];
    float v[3 * LANES];
    LANE_STORE(i, at);
    LANE_STORE(x, v);
    LANE_STORE(y, v + LANES);
    LANE_STORE(z, v + 2 * LANES);
    while (bits) {
        uint k = 31u - clz(bits & -bits);
        bits &= bits - 1u;
        global float *to = p + at[k];
        to[0] += v[k];
        to[stride] += v[LANES + k];
        to[2 * stride] += v[2 * LANES + k];
    }
}

EC_INLINED void scatter_f(global float *restrict p, lane_u i, lane_f v, uint bits)
{
    uint bit = 1;
#define SCATTER_ONE(k)                                                                             \
    if (bits & bit) p[LANE(i, k)] = LANE(v, k);                                                    \
    bit <<= 1;
    EACH_LANE(SCATTER_ONE)
#undef SCATTER_ONE
}

EC_FN uint or_of_lanes(lane_u v)
{
    uint r = 0;
#define OR_ONE(k) r |= LANE(v, k);
    EACH_LANE(OR_ONE)
#undef OR_ONE
    return r;
}

/* Stores the lanes of `bits`, packed, at p[0], p[1], …; up to p[LANES - 1] is overwritten. */
EC_FN void store_packed(uint *p, lane_u v, uint bits)
{
#if LANES == 16 && defined(__AVX512F__) && __has_builtin(__builtin_ia32_compresssf512_mask)
    LANE_STORE(as_lane_u(__builtin_ia32_compresssf512_mask(as_lane_f(v), F(0.0f), (ushort)bits)), p);
#elif LANES == 8 && PERMUTES_LANES
    LANE_STORE(as_uint8(pack8(as_int8(v), bits)), p);
#else
    uint bit = 1;
#define PACK_ONE(k)                                                                                \
    *p = LANE(v, k);                                                                               \
    p += (bits & bit) != 0u;                                                                       \
    bit <<= 1;
    EACH_LANE(PACK_ONE)
#undef PACK_ONE
#endif
}

/* Stores the lanes of `bits`, packed, at p[0], p[1], … */
EC_FN void store_compact(global float *restrict p, lane_f v, uint bits)
{
#if LANES == 16 && defined(__AVX512F__) && __has_builtin(__builtin_ia32_compresssf512_mask) &&     \
    __has_builtin(__builtin_ia32_storeups512_mask)
    lane_f packed = __builtin_ia32_compresssf512_mask(v, F(0.0f), (ushort)bits);
    __builtin_ia32_storeups512_mask((global void *)p, packed, (ushort)((1u << popcount(bits)) - 1u));
#elif LANES == 8 && PERMUTES_LANES && __has_builtin(__builtin_ia32_maskstoreps256)
    int8 first = (int8)(0, 1, 2, 3, 4, 5, 6, 7) < (int8)((int)popcount(bits));
    __builtin_ia32_maskstoreps256((global void *)p, first, as_float8(pack8(as_int8(v), bits)));
#else
    uint bit = 1;
#define STORE_ONE(k)                                                                               \
    if (bits & bit) *p++ = LANE(v, k);                                                             \
    bit <<= 1;
    EACH_LANE(STORE_ONE)
#undef STORE_ONE
#endif
}

#endif
