/* Four floats in a register, for the builder only: SSE where there is any, the compiler's own vectors elsewhere. Both
 * give the same bits. Also boxes of such vectors; lane 3 of a box carries no meaning. */
#ifndef EC_ACCEL_VEC4_H
#define EC_ACCEL_VEC4_H

#include <math.h>
#include <stdint.h>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

typedef float ec_v4 __attribute__((vector_size(16)));
typedef int32_t ec_i4 __attribute__((vector_size(16)));

typedef struct ec_box4 {
    ec_v4 lo, hi;
} ec_box4;

static inline ec_v4 ec_v4_all(float x) { return (ec_v4){x, x, x, x}; }
static inline ec_i4 ec_i4_all(int32_t x) { return (ec_i4){x, x, x, x}; }

/* value < bound ? value : bound in each lane, so a NaN value leaves the bound as it was; the maximum likewise. */
#ifdef __SSE2__
static inline ec_v4 ec_v4_min(ec_v4 value, ec_v4 bound) { return _mm_min_ps(value, bound); }
static inline ec_v4 ec_v4_max(ec_v4 value, ec_v4 bound) { return _mm_max_ps(value, bound); }
static inline ec_i4 ec_v4_truncate(ec_v4 v) { return (ec_i4)_mm_cvttps_epi32(v); }
#else
static inline ec_v4 ec_v4_min(ec_v4 value, ec_v4 bound)
{
    for (int k = 0; k < 4; k++) bound[k] = value[k] < bound[k] ? value[k] : bound[k];
    return bound;
}
static inline ec_v4 ec_v4_max(ec_v4 value, ec_v4 bound)
{
    for (int k = 0; k < 4; k++) bound[k] = value[k] > bound[k] ? value[k] : bound[k];
    return bound;
}
static inline ec_i4 ec_v4_truncate(ec_v4 v)
{
    return (ec_i4){(int32_t)v[0], (int32_t)v[1], (int32_t)v[2], (int32_t)v[3]};
}
#endif

static inline ec_v4 ec_v4_abs(ec_v4 v) { return (ec_v4)((ec_i4)v & ec_i4_all(0x7fffffff)); }

static inline ec_v4 ec_v4_select(ec_i4 mask, ec_v4 yes, ec_v4 no)
{
    return (ec_v4)((mask & (ec_i4)yes) | (~mask & (ec_i4)no));
}

static inline ec_box4 ec_box4_empty(void)
{
    return (ec_box4){ec_v4_all(INFINITY), ec_v4_all(-INFINITY)};
}

static inline void ec_box4_grow(ec_box4 *box, ec_v4 lo, ec_v4 hi)
{
    box->lo = ec_v4_min(lo, box->lo);
    box->hi = ec_v4_max(hi, box->hi);
}

/* Half the surface areas of three boxes, one a lane. Edges are scaled first, so that no product overflows or vanishes
 * in scenes of 1e30 or 1e-30 units. An empty box gives infinity. */
static inline ec_v4 ec_half_areas(const ec_box4 box[3], ec_v4 scale)
{
    ec_v4 a = (box[0].hi - box[0].lo) * scale, b = (box[1].hi - box[1].lo) * scale;
    ec_v4 c = (box[2].hi - box[2].lo) * scale;
    ec_v4 x = {a[0], b[0], c[0], 0.0f}, y = {a[1], b[1], c[1], 0.0f}, z = {a[2], b[2], c[2], 0.0f};
    return x * y + (x + y) * z;
}

/* Returns one over the longest edge, by which boxes inside are scaled. */
static inline ec_v4 ec_box4_scale(const ec_box4 *box)
{
    ec_v4 extent = box->hi - box->lo;
    return ec_v4_all(1.0f / fmaxf(fmaxf(extent[0], extent[1]), extent[2]));
}

#endif
