/* The kernels that a pipeline launches: those of a lane width and some accelerators, built with the features that can change their code and no
 * others. All sets give the same bits, so that one may replace another between two waves. */
#ifndef EC_DEVICE_KERNEL_SET_H
#define EC_DEVICE_KERNEL_SET_H

#include "cl/compile_job.h"
#include "device/stages.h"

#define EC_LANES_MOST 16

/* A kernel and the arguments that it has. New arguments are compared with these, since setting them takes a driver longer. */
typedef struct ec_bound_kernel {
    cl_kernel kernel;
    uint32_t takes;                           /* entries of the wave that a work-item takes */
    uint64_t release;                         /* ec_cl.releases when the arguments were set; 0: they are not */
    uint64_t arguments[EC_STAGE_ARGUMENTS];   /* scalars, and handles of buffers */
} ec_bound_kernel;

typedef struct ec_kernel_set {
    uint32_t lanes;
    uint32_t wave;                            /* paths of the waves that it is launched for */
    uint64_t features;                        /* EC_FEATURE_* that are built in */
    bool calls;                               /* one lane calls functions, which compiles sooner and runs slower, instead of inlining them */
    uint32_t accels;                          /* 1 << accelerator: those that it traverses */
    cl_program programs[EC_LANES_MOST + 1];   /* by lane width */
    ec_bound_kernel stages[EC_STAGE_ID_COUNT];
    ec_bound_kernel traverse[EC_ACCEL_COUNT][2];    /* [0] intersect, [1] connect, as everywhere */
} ec_kernel_set;

/* Releases a set, which may be half built; it is empty afterwards. */
void ec_kernel_set_release(ec_kernel_set *set);

struct ec_pipeline;

/* Returns the empty set of the kernels that are rendered with once they are compiled. */
ec_kernel_set ec_kernel_set_fast(const struct ec_pipeline *pipeline);

/* Builds the kernels of set->lanes and set->accels for what the pipeline is to render. */
ec_result ec_kernel_set_build(struct ec_pipeline *pipeline, ec_kernel_set *set, ec_error *err);

/* Launches each kernel of the pipeline's set over a wave without paths, since some drivers compile at the first launch. compiled, which may be NULL,
 * is told of each. */
ec_result ec_kernel_set_warm(struct ec_pipeline *pipeline, void (*compiled)(void *user, uint32_t done, uint32_t count), void *user, ec_error *err);

/* Describes what another process has to compile for a set. The caller frees the job. */
ec_result ec_kernel_set_job(struct ec_pipeline *pipeline, const ec_kernel_set *set, ec_compile_job *job, ec_error *err);

#endif
