/* Repeats the arithmetic of kernels/lib/instance.h, one corner at a time. */
#include "scene/placed.h"

#include <float.h>
#include <math.h>

static float row(const float *m, const float v[3], float last)
{
    return fmaf(m[0], v[0], fmaf(m[1], v[1], fmaf(m[2], v[2], last)));
}

void ec_placed_point(const ec_placed *p, const float point[3], float out[3])
{
    for (int k = 0; k < 3; k++) out[k] = row(p->place[k], point, p->place[k][3]);
}

static float direction_row(const float *m, const float v[3])
{
    return fmaf(m[0], v[0], fmaf(m[1], v[1], m[2] * v[2]));
}

static void normalize(float v[3])
{
    float length2 = fmaf(v[0], v[0], fmaf(v[1], v[1], v[2] * v[2]));
    float scale = length2 > 0.0f ? 1.0f / sqrtf(length2) : 0.0f;
    for (int k = 0; k < 3; k++) v[k] *= scale;
}

void ec_placed_normal(const ec_placed *p, const float normal[3], float out[3])
{
    for (int k = 0; k < 3; k++) out[k] = direction_row(p->normal[k], normal);
    normalize(out);
}

void ec_placed_tangent(const ec_placed *p, const float tangent[4], float out[4])
{
    for (int k = 0; k < 3; k++) out[k] = direction_row(p->place[k], tangent);
    normalize(out);
    out[3] = p->mirrored ? -tangent[3] : tangent[3];
}

static float product_difference(float a, float b, float c, float d)
{
    float cd = c * d;
    return fmaf(a, b, -cd) - fmaf(c, d, -cd);
}

bool ec_placed_is_flat(const float a[3], const float b[3], const float c[3])
{
    float u[3], v[3], most = 0.0f;
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        most = fmaxf(most, fabsf(product_difference(u[i], v[j], u[j], v[i])));
    }
    return !(most >= FLT_MIN);
}
