/* Vectors of three doubles. Host references repeat their bits, so the order of operations must not change. */
#ifndef EC_BASE_VEC3_H
#define EC_BASE_VEC3_H

#include <math.h>
#include <stdbool.h>

/* For numbers that are not NaN. fmin and fmax handle NaN, and are calls into the C library. */
static inline double ec_lesser(double a, double b) { return b < a ? b : a; }
static inline double ec_greater(double a, double b) { return b > a ? b : a; }

static inline double ec_dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static inline void ec_cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Returns the square of the distance of two points. */
static inline double ec_square_between(const float a[3], const float b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += ((double)a[k] - b[k]) * ((double)a[k] - b[k]);
    return sum;
}

/* Computes the normal of the triangle a, b, c, whose length is twice the area. */
static inline void ec_triangle_normal(const float a[3], const float b[3], const float c[3], double out[3])
{
    double u[3], v[3];
    for (int k = 0; k < 3; k++) u[k] = (double)b[k] - a[k], v[k] = (double)c[k] - a[k];
    ec_cross(u, v, out);
}

/* Normalises v. Returns false, and leaves v unchanged, if its length is 0 or not finite. */
static inline bool ec_normalize(double v[3])
{
    double length = sqrt(ec_dot(v, v));
    if (!(length > 0) || !isfinite(length)) return false;
    for (int k = 0; k < 3; k++) v[k] /= length;
    return true;
}

#endif
