/* A job's kernels, compiled one by one, by one process or by several that see the same states. */
#ifndef EC_CL_COMPILE_RUN_H
#define EC_CL_COMPILE_RUN_H

#include <stdatomic.h>

#include "cl/compile_job.h"

enum { EC_COMPILE_OPEN, EC_COMPILE_TAKEN, EC_COMPILE_DONE }; /* nobody is at it; somebody is, or was when its process ended; it is in the driver's cache */

/* In memory that the processes share. */
typedef struct ec_compile_states {
    atomic_uchar programs[EC_COMPILE_PROGRAMS], kernels[EC_COMPILE_KERNELS];
} ec_compile_states;

/* At the start of a file in memory, before the jobs: of the first one. NULL where it cannot be mapped. */
ec_compile_states *ec_compile_states_map(int file);
void ec_compile_states_unmap(ec_compile_states *states); /* NULL is fine */

typedef struct ec_compile_run {
    ec_cl *cl;
    const ec_compile_job *job;
    ec_compile_states *states;
    cl_program programs[EC_COMPILE_PROGRAMS]; /* those that were built here */
    cl_mem buffers[2];                        /* zeros, and the constants */
} ec_compile_run;

/* To be ended, on failure too. What it points at has to stay. */
ec_result ec_compile_run_begin(ec_cl *cl, const ec_compile_job *job, ec_compile_states *states, ec_compile_run *run, ec_error *err);
void ec_compile_run_end(ec_compile_run *run);

/* Compiles a kernel, for which it builds its program where that was not built here. */
ec_result ec_compile_run_kernel(ec_compile_run *run, uint32_t kernel, ec_error *err);

/* Those of the first `count` that nobody is at, from the first on; tells of each. */
ec_result ec_compile_run_open(ec_compile_run *run, uint32_t count, void (*compiled)(uint32_t kernel), ec_error *err);

/* All, but for what others have taken and finish. */
ec_result ec_compile_run_all(ec_compile_run *run, void (*compiled)(uint32_t kernel), ec_error *err);

/* All of a job that nobody else is at; it is done then (ec_compile_job_done). */
ec_result ec_compile_job_run(ec_cl *cl, const ec_compile_job *job, ec_error *err);

/* The last needed kernel that nobody is at, and that no program under way elsewhere has to be waited for: it is the caller's then. False: there is none. */
bool ec_compile_run_take(ec_compile_run *run, uint32_t *kernel);

/* Are all done? */
bool ec_compile_states_are_done(const ec_compile_states *states, uint32_t kernel_count);

#endif
