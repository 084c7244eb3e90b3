#include <math.h>

#include "robust/precision/draw.h"
#include "robust/precision/inputs.h"

static void cross(const double *a, const double *b, double *c)
{
    for (int k = 0; k < 3; k++) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Triangles of size 1. A tenth are slivers down to 1 : 10^5; half are up to 10^4 sizes from the origin. */
static void draw_triangle(uint64_t *random, double v[3][3])
{
    double at[3], far = ec_random_unit(random) < 0.5 ? 0 : ec_draw_log(random, 1, 1e4);
    ec_draw_direction(random, at);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) v[i][k] = at[k] * far + ec_random_between(random, -1, 1);
    if (ec_random_unit(random) > 0.1) return;
    double thin = ec_draw_log(random, 1e-5, 1e-1), along = ec_random_unit(random);
    for (int k = 0; k < 3; k++) v[2][k] = v[0][k] + along * (v[1][k] - v[0][k]) + thin * ec_random_between(random, -1, 1);
}

static void draw_barycentrics(uint64_t *random, double *b)
{
    double root = sqrt(ec_random_unit(random)), u = ec_random_unit(random);
    b[0] = 1 - root;
    b[1] = root * (1 - u);
    b[2] = root * u;
    if (ec_random_unit(random) < 0.25) { /* near an edge */
        double tiny = ec_draw_log(random, 1e-8, 1e-2);
        b[ec_draw_one(random, 3)] = tiny;
        double sum = b[0] + b[1] + b[2];
        for (int k = 0; k < 3; k++) b[k] /= sum;
    }
}

void ec_inputs_hit(uint64_t *random, float *x)
{
    double v[3][3], b[3], e1[3], e2[3], n[3], wo[3];
    draw_triangle(random, v);
    draw_barycentrics(random, b);
    for (int i = 0; i < 3; i++) ec_put(x + 3 * i, v[i]);
    x[9] = (float)b[1];
    x[10] = (float)b[2];
    for (int k = 0; k < 6; k++)
        x[11 + k] =
            (float)(ec_random_unit(random) < 0.9 ? ec_random_unit(random) : 0.5 + ec_draw_log(random, 1e-5, 1e-2));
    for (int k = 0; k < 3; k++) e1[k] = v[1][k] - v[0][k], e2[k] = v[2][k] - v[0][k];
    cross(e1, e2, n);
    double bend = ec_random_unit(random) < 0.25 ? 1.5 : 0.3, length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; i++) {
        double bent[3];
        for (int k = 0; k < 3; k++) bent[k] = n[k] / length + ec_random_between(random, -bend, bend);
        ec_put_unit(x + 18 + 3 * i, bent);
    }
    for (int k = 0; k < 3; k++) n[k] /= length;
    ec_draw_direction_about(random, n,
                            ec_draw_sign(random, ec_random_unit(random) < 0.5 ? ec_draw_log(random, 1e-4, 1)
                                                                              : ec_random_between(random, 0.1, 1)),
                            wo);
    ec_put(x + 27, wo);
    x[30] = ec_float_of_bits(0);
}

void ec_inputs_mapped_hit(uint64_t *random, float *x)
{
    ec_inputs_hit(random, x);
    x[30] = ec_float_of_bits(EC_MATERIAL_WORDS);
}

void ec_inputs_values(uint64_t *random, float *x)
{
    ec_inputs_hit(random, x);
    for (int k = 0; k < 3; k++) x[k] = (float)ec_draw_sign(random, ec_draw_log(random, 1e-3, 1e3));
}

void ec_inputs_offset(uint64_t *random, float *x)
{
    double v[3];
    for (int k = 0; k < 3; k++) {
        x[k] = (float)ec_draw_sign(random, ec_draw_log(random, 1e-3, 1e4));
        x[3 + k] = (float)(fabs(x[k]) * ec_random_between(random, 3, 9) * 0x1p-24);
    }
    ec_draw_direction(random, v);
    ec_put(x + 6, v);
    ec_draw_direction(random, v);
    ec_put(x + 9, v);
}

void ec_inputs_box(uint64_t *random, float *x)
{
    double o[3], d[3], t = ec_draw_log(random, 1e-2, 1e3), far = ec_random_unit(random) < 0.5 ? 1 : ec_draw_log(random, 1, 1e4);
    ec_draw_direction(random, d);
    for (int k = 0; k < 3; k++) {
        o[k] = ec_random_between(random, -far, far);
        double size = ec_draw_log(random, 1e-3, 1), lo = o[k] + t * d[k] - ec_random_unit(random) * size;
        x[6 + k] = (float)lo;
        x[9 + k] = (float)(lo + size);
    }
    ec_put(x, o);
    ec_put(x + 3, d);
}

void ec_inputs_triangle(uint64_t *random, float *x)
{
    double v[3][3], b[3], o[3], d[3], t = ec_draw_log(random, 1e-4, 1e4);
    draw_triangle(random, v);
    draw_barycentrics(random, b);
    ec_draw_direction(random, d);
    for (int k = 0; k < 3; k++) o[k] = b[0] * v[0][k] + b[1] * v[1][k] + b[2] * v[2][k] - t * d[k];
    ec_put(x, o);
    ec_put(x + 3, d);
    for (int i = 0; i < 3; i++) ec_put(x + 6 + 3 * i, v[i]);
}

/* Fills the rest of a light's record, which starts at word 3. */
static void put_emission(uint64_t *random, uint32_t kind, float *x)
{
    for (int k = 0; k < 3; k++) x[12 + k] = (float)ec_draw_log(random, 1e-3, 1e3);
    x[15] = ec_float_of_bits(kind);
    x[16] = ec_float_of_bits(EC_NO_ID);
}

/* p at any distance and angle. A third of the lamps are far larger than their distance. */
void ec_inputs_light(uint64_t *random, float *x)
{
    double v[3][3], b[3], n[3], e1[3], e2[3], away[3], distance = ec_draw_log(random, 1e-5, 1e3);
    draw_triangle(random, v);
    draw_barycentrics(random, b);
    for (int k = 0; k < 3; k++) e1[k] = v[1][k] - v[0][k], e2[k] = v[2][k] - v[0][k];
    cross(e1, e2, n);
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++) n[k] /= length;
    ec_draw_direction_about(random, n,
                            ec_random_unit(random) < 0.25 ? ec_draw_log(random, 1e-5, 1)
                                                          : ec_random_between(random, 0.1, 1),
                            away);
    for (int i = 0; i < 3; i++) ec_put(x + 3 + 3 * i, v[i]);
    double height = 0, coordinate = 1;
    for (; height < 16 * 0x1p-24 * coordinate; distance *= 4) { /* nearer points would have positions in the plane that are mere rounding */
        height = coordinate = 0;
        for (int k = 0; k < 3; k++) {
            x[k] = (float)(b[0] * v[0][k] + b[1] * v[1][k] + b[2] * v[2][k] + distance * away[k]);
            height += n[k] * ((double)x[k] - (double)x[3 + k]);
            coordinate = fmax(coordinate, fabs((double)x[k]));
        }
        height = fabs(height);
    }
    x[17] = (float)ec_draw_log(random, 1e-6, 1);
    x[18] = (float)(x[17] * 2 / length);
    put_emission(random, EC_KIND_TRIANGLE | EC_LIGHT_TWO_SIDED, x);
    x[19] = ec_draw_unit(random);
    x[20] = ec_draw_unit(random);
}

void ec_inputs_spot(uint64_t *random, float *x)
{
    double p[3], d[3], w[3], outer = ec_draw_log(random, 1e-3, 1.5), inner = outer * ec_random_between(random, 0, 0.99);
    double distance = ec_draw_log(random, 1e-5, 1e3);
    ec_draw_direction(random, d);
    ec_draw_direction_about(random, d, cos(outer * ec_random_unit(random)), w);
    for (int k = 0; k < 3; k++) {
        p[k] = ec_random_between(random, -1, 1);
        x[3 + k] = (float)(p[k] - distance * w[k]);
    }
    ec_put(x, p);
    ec_put(x + 6, d);
    x[9] = (float)(1 / fmax(cos(inner) - cos(outer), 0.001)); /* the minimum of KHR_lights_punctual */
    x[10] = (float)cos(outer);
    x[11] = (float)(ec_random_unit(random) < 0.5 ? 0 : 1 / (distance * ec_random_between(random, 1.01, 10)));
    put_emission(random, EC_KIND_SPOT, x);
}

/* Luminances of any contrast, or none. The second linear function multiplies a sine and may begin at 0, where its relative slope is
 * steepest. */
void ec_inputs_patch(uint64_t *random, float *x)
{
    for (int k = 0; k < 2; k++) x[k] = (float)ec_draw_log(random, 1e-6, 1);
    if (ec_random_unit(random) < 0.25) x[ec_draw_one(random, 2)] = 0;
    x[3] = (float)ec_draw_log(random, 1e-3, 1);
    x[2] = (float)(x[3] * (ec_random_unit(random) < 0.25 ? 0 : ec_random_between(random, 1.0 / 3, 1)));
    x[4] = (float)(ec_random_unit(random) < 0.125 ? 0 : ec_draw_unit(random));
}

/* Two numbers of 32 bits that are not NaN. */
void ec_inputs_sample(uint64_t *random, float *x)
{
    for (int k = 0; k < 2; k++) x[k] = ec_float_of_bits((uint32_t)(ec_draw_unit(random) * 0x1p32) & 0xbfffffffu); /* not the bits of NaNs */
}

void ec_inputs_texture(uint64_t *random, float *x)
{
    x[0] = ec_float_of_bits(ec_draw_one(random, 3));
    for (int k = 1; k < 3; k++) {
        uint32_t kind = ec_draw_one(random, 3);
        double u = ec_random_between(random, -3, 3);
        if (kind == 0) u = ec_random_between(random, -1000, 1000);
        if (kind == 1) u = ec_draw_one(random, 16) / 16.0 + ec_draw_sign(random, ec_draw_log(random, 1e-8, 1e-3));
        x[k] = (float)u;
    }
}

void ec_inputs_slot(uint64_t *random, float *x) { x[0] = ec_float_of_bits(ec_draw_one(random, 1u << 24)); }

void ec_inputs_edge(uint64_t *random, float *x)
{
    double p[3], q[3], right[3], up[3], forward[3], apart = ec_draw_log(random, 1e-4, 10);
    for (int k = 0; k < 3; k++) {
        p[k] = ec_random_between(random, -10, 10);
        q[k] = p[k] + ec_random_between(random, -apart, apart);
    }
    ec_draw_direction(random, forward);
    ec_draw_direction_about(random, forward, 0, right);
    cross(right, forward, up);
    for (int k = 0; k < 3; k++) {
        right[k] *= 0.7;
        up[k] *= 0.4;
    }
    ec_put(x, p);
    ec_put(x + 3, q);
    ec_put(x + 6, right);
    ec_put(x + 9, up);
    ec_put(x + 12, forward);
}
