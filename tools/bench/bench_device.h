/* eclat's own traversal kernels on the rays of bench_rays.h, launched as the pipeline does. */
#ifndef EC_BENCH_DEVICE_H
#define EC_BENCH_DEVICE_H

#include <stdbool.h>

#include "accel/accel.h"
#include "bench_rays.h"
#include "cl/cl.h"
#include "device/stages.h"

/* One set of kernels: the embedded ones, or those of another kernels/ folder. */
typedef struct bench_kernels {
    const char *folder; /* NULL: embedded */
    cl_program programs[EC_ACCEL_COUNT];
    cl_kernel kernels[EC_ACCEL_COUNT][2]; /* [1]: shadow rays */
} bench_kernels;

typedef struct bench_device {
    ec_cl cl;
    uint32_t lanes, most_rays, stride;
    float scene_max;
    cl_mem buffers[EC_ARG_COUNT];
    cl_mem accel_buffers[EC_ACCEL_COUNT][EC_ACCEL_BUFFERS];
    ec_accel_stats accel_stats[EC_ACCEL_COUNT];
    cl_mem queues[BENCH_KIND_COUNT];
    uint32_t counts[BENCH_KIND_COUNT];
} bench_device;

/* Opens the device, builds the accelerators whose bits are set, and makes queues for up to most_rays rays. lanes 0: the device's. */
ec_result bench_device_open(bench_device *d, const char *id, uint32_t lanes, const bench_mesh *mesh, float scene_max,
                            uint32_t most_rays, uint32_t accels, float grid_density, ec_error *err);
void bench_device_close(bench_device *d);

ec_result bench_device_kernels(bench_device *d, bench_kernels *k, uint32_t accels, ec_error *err);
void bench_device_release(bench_kernels *k);

/* Fills the queue of that kind. */
ec_result bench_device_rays(bench_device *d, bench_kind kind, const bench_rays *rays, ec_error *err);

/* One launch; seconds until it is done. */
ec_result bench_device_trace(bench_device *d, const bench_kernels *k, uint32_t accel, bench_kind kind, double *seconds,
                             ec_error *err);
/* Another launch, and what it found: prim, b1, b2 of each ray (shadow rays: prim 0 or UINT32_MAX). */
typedef struct bench_found {
    uint32_t prim;
    float b1, b2;
} bench_found;
ec_result bench_device_found(bench_device *d, const bench_kernels *k, uint32_t accel, bench_kind kind,
                             bench_found *found, ec_error *err);

#endif
