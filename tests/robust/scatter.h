/* Runs the BSDF on the device over arrays. */
#ifndef EC_TESTS_ROBUST_SCATTER_H
#define EC_TESTS_ROBUST_SCATTER_H

#include <math.h>

#include "base/random.h"
#include "robust/scatter_fields.h"
#include "selftest/cases.h"

#define EC_SCATTER_N 32768u /* items of one run: one launch size, which PoCL compiles once */
#define EC_PI_DOUBLE 3.14159265358979323846
#define EC_U 0x1p-24        /* the largest relative error of one rounding */

typedef struct ec_scatter_run {
    cl_program program;
    float *in, *out;        /* indexed by ec_scatter_in and ec_scatter_out, EC_SCATTER_N values each */
} ec_scatter_run;

ec_result ec_scatter_open(ec_selftest *t, ec_scatter_run *run, ec_error *err); /* after a failure there is nothing to close */
ec_result ec_scatter_open_with(ec_selftest *t, const char *more, ec_scatter_run *run, ec_error *err); /* more: "+EC_FEATURE_…" */
void ec_scatter_close(ec_scatter_run *run);
ec_result ec_scatter_go(ec_selftest *t, ec_scatter_run *run, ec_error *err);
ec_result ec_scatter_films(ec_selftest *t, ec_scatter_run *run, ec_error *err); /* three results: red, green, blue */

/* Values that all items of a run share: a grey dielectric coat over a base that transmits `transmission` of the light. */
typedef struct ec_scatter_material {
    double base, f0, metallic, alpha, transmission, eta; /* eta 1: thin, or opaque */
    bool smooth;
    double along; /* the lobe's width along x, in kernels with ANISOTROPY; 0: alpha */
} ec_scatter_material;
/* A perfect metal; white glass, whose f0 follows from its index. */
ec_scatter_material ec_scatter_metal(double alpha);
ec_scatter_material ec_scatter_glass(double alpha, double eta);
void ec_scatter_set(ec_scatter_run *run, uint32_t i, const ec_scatter_material *m);

static inline void ec_scatter_put(ec_scatter_run *run, int field, uint32_t i, double value)
{
    run->in[(uint32_t)field * EC_SCATTER_N + i] = (float)value;
}
static inline double ec_scatter_given(const ec_scatter_run *run, int field, uint32_t i)
{
    return (double)run->in[(uint32_t)field * EC_SCATTER_N + i];
}
static inline double ec_scatter_got(const ec_scatter_run *run, int field, uint32_t i)
{
    return (double)run->out[(uint32_t)field * EC_SCATTER_N + i];
}
void ec_scatter_put3(ec_scatter_run *run, int field, uint32_t i, double x, double y, double z);
/* The unit vector with this z and azimuth. */
void ec_scatter_put_direction(ec_scatter_run *run, int field, uint32_t i, double z, double azimuth);
void ec_scatter_given3(const ec_scatter_run *run, int field, uint32_t i, double w[3]);
void ec_scatter_got3(const ec_scatter_run *run, int field, uint32_t i, double w[3]);

/* In double: GGX's distribution of normals, and its masking cos sqrt(1 + alpha^2 tan^2); the density of wi sampled by visible normals of a
 * reflecting surface; Fresnel's unpolarised reflectance. */
double ec_exact_ggx(double alpha, const double h[3]);
double ec_exact_masking(double alpha, double cosine);
double ec_exact_visible(double alpha, const double wo[3], const double wi[3]);
double ec_exact_fresnel(double cosine, double eta);

/* The largest value so far, and its place. */
typedef struct ec_worst {
    double value;
    char note[120];
} ec_worst;
void ec_worst_take(ec_worst *worst, double value, const char *format, ...) __attribute__((format(printf, 3, 4)));

#endif
