#include "robust/scatter.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "kernel/kernel_run.h"
#include "shared/features.h"

ec_result ec_scatter_open_with(ec_selftest *t, const char *more, ec_scatter_run *run, ec_error *err)
{
    char options[400];
    *run = (ec_scatter_run){.in = calloc((size_t)EC_SCATTER_INS * EC_SCATTER_N, sizeof *run->in),
                            .out = calloc((size_t)EC_SCATTER_OUTS * EC_SCATTER_N, sizeof *run->out)};
    snprintf(options, sizeof options, "-DLANES=%u -DFEATURES=(EC_FEATURE_SPECULAR+EC_FEATURE_SMOOTH+EC_FEATURE_TRANSMISSION%s)",
             t->lanes, more);
    char *source = kernel_flatten("robust/scatter.cl");
    ec_result result = run->in && run->out && source ? ec_program_build(t->cl, "scatter", source, options, &run->program, err)
                                                     : ec_fail(err, "no memory for directions, or no kernel");
    free(source);
    if (result != EC_OK) ec_scatter_close(run);
    return result;
}

ec_result ec_scatter_open(ec_selftest *t, ec_scatter_run *run, ec_error *err) { return ec_scatter_open_with(t, "", run, err); }

void ec_scatter_close(ec_scatter_run *run)
{
    if (run->program) clReleaseProgram(run->program);
    free(run->in);
    free(run->out);
    *run = (ec_scatter_run){0};
}

static ec_result run_kernel(ec_selftest *t, ec_scatter_run *run, const char *name, ec_error *err)
{
    uint32_t n = EC_SCATTER_N;
    const ec_array arrays[] = {EC_SCALAR(n), EC_IN(run->in, (size_t)EC_SCATTER_INS * n),
                               EC_OUT(run->out, (size_t)EC_SCATTER_OUTS * n)};
    return ec_kernel_call(t->cl, run->program, name, n / t->lanes, 64, arrays, 3, err);
}

ec_result ec_scatter_go(ec_selftest *t, ec_scatter_run *run, ec_error *err) { return run_kernel(t, run, "ec_scatter", err); }

ec_result ec_scatter_films(ec_selftest *t, ec_scatter_run *run, ec_error *err) { return run_kernel(t, run, "ec_films", err); }

ec_scatter_material ec_scatter_metal(double alpha)
{
    return (ec_scatter_material){.base = 1, .f0 = 1, .metallic = 1, .alpha = alpha, .eta = 1};
}

ec_scatter_material ec_scatter_glass(double alpha, double eta)
{
    double r = (eta - 1) / (eta + 1);
    return (ec_scatter_material){.base = 1, .f0 = eta != 1 ? r * r : 0.04, .alpha = alpha, .transmission = 1, .eta = eta};
}

void ec_scatter_set(ec_scatter_run *run, uint32_t i, const ec_scatter_material *m)
{
    ec_scatter_put3(run, EC_SCATTER_BASE, i, m->base, m->base, m->base);
    ec_scatter_put(run, EC_SCATTER_F0, i, m->f0);
    ec_scatter_put(run, EC_SCATTER_F90, i, 1);
    ec_scatter_put(run, EC_SCATTER_METALLIC, i, m->metallic);
    ec_scatter_put(run, EC_SCATTER_ALPHA, i, m->alpha);
    ec_scatter_put(run, EC_SCATTER_TRANSMISSION, i, m->transmission);
    ec_scatter_put(run, EC_SCATTER_ETA, i, m->eta);
    ec_scatter_put(run, EC_SCATTER_SMOOTH, i, m->smooth);
    ec_scatter_put(run, EC_SCATTER_STRETCH, i, m->along > 0 ? m->along / m->alpha : 1);
}

void ec_scatter_put3(ec_scatter_run *run, int field, uint32_t i, double x, double y, double z)
{
    ec_scatter_put(run, field, i, x);
    ec_scatter_put(run, field + 1, i, y);
    ec_scatter_put(run, field + 2, i, z);
}

void ec_scatter_put_direction(ec_scatter_run *run, int field, uint32_t i, double z, double azimuth)
{
    double r = sqrt((1 - z) * (1 + z));
    ec_scatter_put3(run, field, i, r * cos(azimuth), r * sin(azimuth), z);
}

void ec_scatter_given3(const ec_scatter_run *run, int field, uint32_t i, double w[3])
{
    for (int k = 0; k < 3; k++) w[k] = ec_scatter_given(run, field + k, i);
}

void ec_scatter_got3(const ec_scatter_run *run, int field, uint32_t i, double w[3])
{
    for (int k = 0; k < 3; k++) w[k] = ec_scatter_got(run, field + k, i);
}

double ec_exact_ggx(double alpha, const double h[3])
{
    double a2 = alpha * alpha, k = (h[0] * h[0] + h[1] * h[1]) / a2 + h[2] * h[2];
    return 1 / (EC_PI_DOUBLE * a2 * k * k);
}

double ec_exact_masking(double alpha, double cosine)
{
    return sqrt(cosine * cosine * (1 - alpha * alpha) + alpha * alpha);
}

double ec_exact_visible(double alpha, const double wo[3], const double wi[3])
{
    double h[3] = {wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]}, length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (int k = 0; k < 3; k++) h[k] /= length;
    return ec_exact_ggx(alpha, h) / (2 * (wo[2] + ec_exact_masking(alpha, wo[2])));
}

double ec_exact_fresnel(double cosine, double eta)
{
    double sine2 = (1 - cosine) * (1 + cosine) / (eta * eta);
    if (sine2 >= 1 || cosine <= 0) return 1;
    double beyond = sqrt(1 - sine2);
    double s = (cosine - eta * beyond) / (cosine + eta * beyond), p = (eta * cosine - beyond) / (eta * cosine + beyond);
    return (s * s + p * p) / 2;
}

void ec_worst_take(ec_worst *worst, double value, const char *format, ...)
{
    if (isnan(worst->value) || value <= worst->value) return; /* NaN replaces any value, and stays */
    worst->value = value;
    va_list list;
    va_start(list, format);
    vsnprintf(worst->note, sizeof worst->note, format, list);
    va_end(list);
}
