/* Replaces lib/lanes.h, lib/elementary.h and OpenCL's built-ins where kernels are compiled as C in double precision
 * (tools/double_kernels.py): one lane, and libm instead of polynomials. Memory that is only read holds floats, as on the device. Functions
 * of a float's bits round to float first. Include it only in that one file: it redefines names of C. */
#ifndef EC_PRECISION_DOUBLE_H
#define EC_PRECISION_DOUBLE_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/bits.h"
#include "robust/precision/internal.h"
#include "shared/types.h"

#define EC_DEVICE_CODE
#define EC_LIB_LANES_H
#define EC_LIB_ELEMENTARY_H
#define EC_FN static inline
#define EC_INLINED static inline
#define EC_CALLED static

#define kernel
#define global
#define constant const
typedef uint32_t uint;

/* One work-item a call: the caller points at the work-item's words. */
#define get_global_id(dimension) 0u
#define get_group_id(dimension) 0u

#define LANES 1
#define LANE_NUMBERS 0u
#define LANE_STORE(v, p) (*(p) = (v))
#define LANE(v, k) (v)
typedef double lane_f;
typedef int32_t lane_i;
typedef uint32_t lane_u;
#define F(x) ((lane_f)(x))
#define I(x) ((lane_i)(x))
#define U(x) ((lane_u)(x))
#define TRUE_MASK 1

static inline double as_double(uint32_t bits) { return ec_float_of_bits(bits); }
static inline uint32_t as_uint(double x) { return ec_bits_of_float((float)x); }
EC_FN lane_f as_lane_f(lane_u v) { return as_double(v); }
EC_FN lane_u as_lane_u(lane_f v) { return as_uint(v); }
EC_FN lane_f to_lane_f(lane_u v) { return v; }
EC_FN lane_f int_to_lane_f(lane_i v) { return v; }
EC_FN lane_i to_lane_i(lane_f v) { return (lane_i)v; }
EC_FN lane_u int_to_lane_u(lane_i v) { return (lane_u)v; }
EC_FN lane_i uint_to_lane_i(lane_u v) { return (lane_i)v; }
EC_FN bool any_lane(lane_i m) { return m != 0; }

typedef struct quad {
    lane_f a, b, c, d;
} quad;
EC_FN lane_f gather_f(const float *p, lane_u i) { return p[i]; }
EC_FN lane_f gather_constant_f(const float *p, lane_u i) { return p[i]; }
EC_FN lane_u gather_u(const uint32_t *p, lane_u i) { return p[i]; }
EC_FN quad gather_quad(const float *p, lane_u i)
{
    quad q = {p[i], p[i + 1], p[i + 2], p[i + 3]};
    return q;
}
EC_FN bool all_same(lane_u v) { return false; }
EC_FN lane_u divide(lane_u n, uint d) { return n / d; }
EC_FN quad gather_quad_if(bool is_same, const float *p, lane_u i) { return gather_quad(p, i); }
typedef struct pair {
    lane_u a, b;
} pair;
EC_FN pair gather_pair(const uint32_t *p, lane_u i)
{
    pair r = {p[i], p[i + 1]};
    return r;
}
EC_FN void scatter_f(double *p, lane_u i, lane_f v, uint bits)
{
    (void)bits;
    p[i] = v;
}

static inline double least_double(double a, double b) { return b < a ? b : a; }
static inline int32_t least_int(int32_t a, int32_t b) { return b < a ? b : a; }
static inline uint32_t least_uint(uint32_t a, uint32_t b) { return b < a ? b : a; }
static inline double most_double(double a, double b) { return a < b ? b : a; }
static inline int32_t most_int(int32_t a, int32_t b) { return a < b ? b : a; }
static inline uint32_t most_uint(uint32_t a, uint32_t b) { return a < b ? b : a; }
#define min(a, b) _Generic((a) + (b), double: least_double, int32_t: least_int, uint32_t: least_uint)(a, b)
#define max(a, b) _Generic((a) + (b), double: most_double, int32_t: most_int, uint32_t: most_uint)(a, b)
static inline uint32_t clz(uint32_t x)
{
    uint32_t n = 0;
    for (uint32_t bit = 0x80000000u; bit && !(x & bit); bit >>= 1) n++;
    return n;
}
static inline uint32_t mul_hi(uint32_t a, uint32_t b) { return (uint32_t)((uint64_t)a * b >> 32); }

#define EC_PI 3.14159265358979323846
#define EC_INV_PI 0.31830988618379067154

/* Reduces u to quarters first, which is exact. */
EC_FN lane_f sincos_2pi(lane_f u, lane_f *cosine)
{
    double q = floor(u * 4 + 0.5), r = (u * 4 - q) * (0.5 * EC_PI), s = sin(r), c = cos(r);
    int quadrant = (int)q & 3;
    double turned[4] = {s, c, -s, -c};
    *cosine = turned[(quadrant + 1) & 3];
    return turned[quadrant];
}

EC_FN lane_f exp_negative(lane_f x) { return x < -126.5 * log(2.0) ? 0 : exp(x); }
EC_FN lane_f log_unit(lane_f x, lane_f y) { return x > 0.5 ? log1p(-y) : log(fmax(x, 0x1p-126)); }
EC_FN lane_f atan2_over_2pi(lane_f y, lane_f x) { return x == 0 && y == 0 ? y : atan2(y, x) / (2 * EC_PI); }

#endif
