#include "robust/precision/inputs.h"

#include <math.h>
#include <stdbool.h>

#include "robust/precision/draw.h"

void ec_inputs_turn(uint64_t *random, float *x)
{
    x[0] = ec_draw_unit(random);
    if (ec_draw_one(random, 3) == 0)
        x[0] = (float)fabs(ec_draw_one(random, 8) / 8.0 + ec_draw_sign(random, ec_draw_log(random, 0x1p-24, 1e-2)));
}

void ec_inputs_exponent(uint64_t *random, float *x) { x[0] = (float)-ec_draw_log(random, 1e-8, 87); }

/* A number and its complement, the smaller of which is exact. */
void ec_inputs_logarithm(uint64_t *random, float *x)
{
    double y = ec_draw_log(random, 1e-37, 0.5);
    bool swap = ec_random_unit(random) < 0.5;
    x[swap] = (float)y;
    x[!swap] = (float)(1 - y);
}

void ec_inputs_plane(uint64_t *random, float *x)
{
    double angle = ec_random_between(random, -M_PI, M_PI), length = ec_draw_log(random, 1e-6, 1e6);
    if (ec_random_unit(random) < 0.5)
        angle = ec_draw_one(random, 8) * (M_PI / 4) + ec_draw_sign(random, ec_draw_log(random, 1e-8, 1e-2));
    x[0] = (float)(length * sin(angle));
    x[1] = (float)(length * cos(angle));
}

static void draw_vector(uint64_t *random, double least, double most, double *v)
{
    double length = ec_draw_log(random, least, most);
    ec_draw_direction(random, v);
    for (int k = 0; k < 3; k++) v[k] *= length;
}

/* Two vectors; half of the pairs are nearly parallel or nearly orthogonal. */
void ec_inputs_two_vectors(uint64_t *random, float *x)
{
    double a[3], b[3], n[3], kind = ec_random_unit(random);
    draw_vector(random, 1e-3, 1e3, a);
    draw_vector(random, 1e-3, 1e3, b);
    double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]), tiny = ec_draw_sign(random, ec_draw_log(random, 1e-7, 1e-1));
    for (int k = 0; k < 3; k++) n[k] = a[k] / length;
    if (kind < 0.25) ec_draw_direction_about(random, n, tiny, b);
    if (kind > 0.75) ec_draw_direction_about(random, n, sqrt(1 - tiny * tiny), b);
    ec_put(x, a);
    ec_put(x + 3, b);
}

void ec_inputs_vector(uint64_t *random, float *x)
{
    double v[3];
    draw_vector(random, 1e-15, 1e15, v);
    ec_put(x, v);
}

void ec_inputs_colour(uint64_t *random, float *x)
{
    for (int k = 0; k < 3; k++) x[k] = (float)ec_draw_log(random, 1e-6, 1e6);
}

void ec_inputs_direction(uint64_t *random, float *x)
{
    double v[3];
    ec_draw_direction(random, v);
    ec_put_unit(x, v);
}

void ec_inputs_two_directions(uint64_t *random, float *x)
{
    ec_inputs_direction(random, x);
    ec_inputs_direction(random, x + 3);
}

void ec_inputs_densities(uint64_t *random, float *x)
{
    x[0] = (float)ec_draw_log(random, 1e-12, 1e12);
    x[1] = (float)(ec_random_unit(random) < 0.5 ? ec_draw_log(random, 1e-12, 1e12)
                                                : x[0] * (1 + ec_random_between(random, -1e-3, 1e-3)));
}

void ec_inputs_share(uint64_t *random, float *x)
{
    x[0] = (float)(ec_random_unit(random) < 0.5 ? ec_draw_log(random, 1e-7, 1) : 1 - ec_draw_log(random, 1e-7, 1));
}

void ec_inputs_distance(uint64_t *random, float *x)
{
    x[0] = (float)ec_draw_log(random, 1e-6, 1e4);
    for (int k = 0; k < 3; k++) x[EC_WORD_absorption + k] = (float)(ec_draw_log(random, 1e-8, 80) / x[0]);
}

/* Narrow lobes, and directions in them. */
void ec_inputs_phase(uint64_t *random, float *x)
{
    double d[3], wi[3];
    const double narrow = ec_random_unit(random) < 0.5 ? ec_draw_log(random, 1e-7, 1) : 1 - ec_draw_log(random, 1e-3, 1);
    x[0] = (float)ec_draw_sign(random, fmin(narrow, 0.999));
    ec_inputs_direction(random, x + 1);
    for (int k = 0; k < 3; k++) d[k] = x[1 + k];
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), fall = ec_draw_log(random, 1e-6, 2);
    for (int k = 0; k < 3; k++) d[k] /= length;
    ec_draw_direction_about(random, d, ec_draw_sign(random, 1 - fall), wi);
    ec_put_unit(x + 4, wi);
    x[7] = ec_draw_unit(random);
    x[8] = ec_draw_unit(random);
}

void ec_inputs_free_way(uint64_t *random, float *x)
{
    x[0] = (float)ec_draw_log(random, 1e-6, 1e6);
    x[1] = ec_draw_unit(random);
}

/* Points in and around the scene's bounding sphere. */
void ec_inputs_fog(uint64_t *random, float *x)
{
    double o[3];
    draw_vector(random, 1e-2, 1e2, o);
    ec_put(x, o);
    ec_inputs_direction(random, x + 3);
    x[6] = (float)ec_draw_log(random, 1e-3, 1e3);
}
