#include "robust/precision/draw.h"

#include <math.h>

double ec_draw_log(uint64_t *random, double a, double b) { return a * pow(b / a, ec_random_unit(random)); }

float ec_draw_unit(uint64_t *random)
{
    double u = ec_random_unit(random);
    uint32_t kind = ec_draw_one(random, 4);
    if (kind == 0) u = ec_draw_log(random, 0x1p-24, 1);
    if (kind == 1) u = 1 - ec_draw_log(random, 0x1p-24, 1);
    return (float)(floor(u * 0x1p24) * 0x1p-24);
}

void ec_put(float *x, const double *v)
{
    for (int k = 0; k < 3; k++) x[k] = (float)v[k];
}

void ec_put_unit(float *x, const double *v)
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++) x[k] = (float)(v[k] / length);
}

void ec_draw_direction_at(uint64_t *random, double z, double *v)
{
    double angle = ec_random_between(random, -M_PI, M_PI), r = sqrt(fmax((1 - z) * (1 + z), 0));
    v[0] = r * cos(angle);
    v[1] = r * sin(angle);
    v[2] = z;
}

void ec_draw_direction(uint64_t *random, double *v)
{
    uint32_t kind = ec_draw_one(random, 4), axis = ec_draw_one(random, 3);
    ec_draw_direction_at(random, ec_random_between(random, -1, 1), v);
    if (kind == 0) { /* close to an axis */
        for (int k = 0; k < 3; k++)
            v[k] = ec_draw_sign(random, ec_random_unit(random) < 0.25 ? 0 : ec_draw_log(random, 1e-9, 1e-2));
        v[axis] = ec_draw_sign(random, 1);
    }
    if (kind == 1) v[axis] = ec_draw_sign(random, ec_random_unit(random) < 0.25 ? 0 : ec_draw_log(random, 1e-9, 1e-2)); /* close to a plane */
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++) v[k] /= length;
}

void ec_draw_direction_about(uint64_t *random, const double *n, double cosine, double *v)
{
    double local[3], sign = copysign(1, n[2]), a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
    double s[3] = {1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]}, t[3] = {b, sign + n[1] * n[1] * a, -n[1]};
    ec_draw_direction_at(random, cosine, local);
    for (int k = 0; k < 3; k++) v[k] = s[k] * local[0] + t[k] * local[1] + n[k] * local[2];
}
