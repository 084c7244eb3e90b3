#include <math.h>
#include <stdbool.h>

#include "robust/precision/draw.h"
#include "robust/precision/inputs.h"

enum { WO = 0, WI = 3, BASE = 6, F0 = 9, F90, METALLIC, ALPHA, TRANSMISSION, ETA, U1, U2, U, STRETCH };

static double draw_grazing(uint64_t *random)
{
    uint32_t kind = ec_draw_one(random, 3);
    if (kind == 0) return ec_draw_log(random, 1e-7, 1);
    return kind == 1 ? 1 - ec_draw_log(random, 1e-7, 1) : ec_random_between(random, 0.01, 1);
}

/* Relative indices: glass to air and back, liquids in each other, nearly equal media. */
static double draw_eta(uint64_t *random, double least)
{
    double eta = ec_random_unit(random) < 0.5 ? ec_random_between(random, 1.1, 2.5) : 1 + ec_draw_log(random, least, 1);
    return ec_random_unit(random) < 0.5 ? eta : 1 / eta;
}

/* A cosine below the critical one, often just below it. */
static double draw_refracted(uint64_t *random, double eta)
{
    double least = eta < 1 ? sqrt(1 - eta * eta) : 0;
    if (ec_random_unit(random) < 0.5) return fmin(least + (1 - least) * ec_draw_log(random, 1e-6, 1), 1);
    return least + (1 - least) * ec_random_between(random, 0.01, 1);
}

void ec_inputs_interface(uint64_t *random, float *x)
{
    double eta = draw_eta(random, 1e-6);
    x[0] = (float)draw_refracted(random, eta);
    x[1] = (float)eta;
}

void ec_inputs_refraction(uint64_t *random, float *x)
{
    double eta = draw_eta(random, 1e-6), m[3], w[3];
    ec_draw_direction(random, m);
    ec_draw_direction_about(random, m, draw_refracted(random, eta), w);
    ec_put(x, w);
    ec_put(x + 3, m);
    x[6] = (float)eta;
}

static void draw_material(uint64_t *random, float *x)
{
    for (int k = 0; k < 3; k++) x[BASE + k] = (float)ec_random_unit(random);
    x[F0] = (float)(ec_random_unit(random) < 0.5 ? 0.04 : ec_random_unit(random));
    x[F90] = ec_random_unit(random) < 0.75 ? 1 : (float)ec_random_between(random, x[F0], 1);
    x[METALLIC] = (float)(0.5 * ec_draw_one(random, 3));
    x[ALPHA] = (float)(ec_random_unit(random) < 0.75 ? ec_draw_log(random, EC_SMOOTH_ALPHA, 1) : 1);
    x[TRANSMISSION] = 0;
    x[ETA] = x[STRETCH] = 1;
    for (int k = 0; k < 3; k++) x[U1 + k] = ec_draw_unit(random);
}

/* A normal from the centre of a lobe of these widths. */
static void draw_normal(uint64_t *random, const float *x, double *m)
{
    double angle = ec_random_between(random, -M_PI, M_PI), r = x[ALPHA] * ec_draw_log(random, 1e-2, 5),
           along = r * cos(angle) * x[STRETCH];
    double across = r * sin(angle), length = sqrt(1 + along * along + across * across);
    m[0] = along / length;
    m[1] = across / length;
    m[2] = 1 / length;
}

/* The width along x: the largest, or between that and the width across. */
static void stretch(uint64_t *random, float *x)
{
    x[STRETCH] = (float)(ec_random_unit(random) < 0.5 ? 1 / x[ALPHA] : pow(1 / x[ALPHA], ec_random_unit(random)));
}

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* wo anywhere above the surface; wi anywhere above it, or wo mirrored at a normal of the lobe. */
static void draw_reflection(uint64_t *random, float *x)
{
    double wo[3], wi[3], m[3];
    bool mirrored = ec_random_unit(random) < 0.75;
    do {
        ec_draw_direction_at(random, draw_grazing(random), wo);
        ec_draw_direction_at(random, draw_grazing(random), wi);
        draw_normal(random, x, m);
        for (int k = 0; mirrored && k < 3; k++) wi[k] = 2 * dot(wo, m) * m[k] - wo[k];
    } while (wi[2] < 1e-8);
    ec_put(x + WO, wo);
    ec_put(x + WI, wi);
}

void ec_inputs_opaque(uint64_t *random, float *x)
{
    draw_material(random, x);
    draw_reflection(random, x);
}

void ec_inputs_highlight(uint64_t *random, float *x)
{
    draw_material(random, x);
    x[ALPHA] = (float)ec_draw_log(random, 0.01, 1); /* below it, Whitted's surfaces are mirrors */
    draw_reflection(random, x);
}

/* A rough interface of two media. Its lobes are no narrower than float half vectors resolve (surface_transmission). */
static void draw_glass(uint64_t *random, float *x)
{
    draw_material(random, x);
    x[METALLIC] = 0;
    x[TRANSMISSION] = (float)(ec_random_unit(random) < 0.5 ? 1 : ec_random_between(random, 0.1, 1));
    do {
        x[ALPHA] = (float)ec_draw_log(random, EC_SMOOTH_ALPHA, 1);
        x[ETA] = (float)draw_eta(random, 1e-3);
    } while (x[ALPHA] * fabs(x[ETA] - 1.0) < EC_SMOOTH_ALPHA);
    double r = (x[ETA] - 1.0) / (x[ETA] + 1.0);
    x[F0] = (float)(r * r);
    x[F90] = 1;
}

static void draw_into_glass(uint64_t *random, float *x)
{
    double wo[3], wi[3], m[3], square;
    do {
        ec_draw_direction_at(random, draw_grazing(random), wo);
        draw_normal(random, x, m);
        double om = dot(wo, m), eta = x[ETA];
        square = om * om + eta * eta - 1;
        for (int k = 0; k < 3; k++) wi[k] = ((om - sqrt(fmax(square, 0))) * m[k] - wo[k]) / eta;
    } while (dot(wo, m) < 1e-7 || square < 1e-8 || wi[2] > -1e-7);
    ec_put(x + WO, wo);
    ec_put(x + WI, wi);
}

void ec_inputs_into_glass(uint64_t *random, float *x)
{
    draw_glass(random, x);
    draw_into_glass(random, x);
}

void ec_inputs_into_brushed_glass(uint64_t *random, float *x)
{
    draw_glass(random, x);
    stretch(random, x);
    draw_into_glass(random, x);
}

void ec_inputs_off_glass(uint64_t *random, float *x)
{
    draw_glass(random, x);
    draw_reflection(random, x);
}

void ec_inputs_off_brushed_glass(uint64_t *random, float *x)
{
    draw_glass(random, x);
    stretch(random, x);
    draw_reflection(random, x);
}

void ec_inputs_thin(uint64_t *random, float *x)
{
    draw_material(random, x);
    x[METALLIC] = 0;
    x[TRANSMISSION] = (float)ec_random_between(random, 0.1, 1);
    draw_reflection(random, x);
    x[WI + 2] = -x[WI + 2];
}

void ec_inputs_smooth_glass(uint64_t *random, float *x)
{
    double wo[3];
    draw_glass(random, x);
    x[ALPHA] = 0;
    ec_draw_direction_at(random, draw_refracted(random, x[ETA]), wo);
    ec_put(x + WO, wo);
}

/* Films, from thinner than light's wavelengths to too thick for colours; on metals and dielectrics, and on glass from both sides. */
void ec_inputs_film(uint64_t *random, float *x)
{
    bool refracts = ec_random_unit(random) < 0.5;
    double eta = refracts ? draw_eta(random, 1e-2) : 1, r = (eta - 1) / (eta + 1);
    x[0] = (float)(refracts ? draw_refracted(random, eta) : draw_grazing(random));
    x[1] = (float)eta;
    x[2] = (float)(ec_random_unit(random) < 0.5 ? ec_random_between(random, 1.2, 2.5) : 1 + ec_draw_log(random, 1e-4, 1));
    x[3] = (float)ec_draw_log(random, 1e-2, 1e4);
    x[4] = (float)(refracts ? r * r : ec_random_unit(random));
    x[5] = refracts;
}

void ec_inputs_dispersion(uint64_t *random, float *x)
{
    x[0] = (float)(1 + ec_draw_log(random, 1e-6, 1.5));
    x[1] = (float)ec_draw_log(random, 1e-3, 10);
}

/* A half vector in place of wo. */
static void draw_half_vector(uint64_t *random, float *x)
{
    double m[3];
    draw_normal(random, x, m);
    if (ec_random_unit(random) < 0.25) ec_draw_direction_at(random, draw_grazing(random), m);
    ec_put(x + WO, m);
}

void ec_inputs_half_vector(uint64_t *random, float *x)
{
    draw_material(random, x);
    draw_half_vector(random, x);
}

void ec_inputs_brushed_half_vector(uint64_t *random, float *x)
{
    draw_material(random, x);
    stretch(random, x);
    draw_half_vector(random, x);
}
