/* Compiles a job's kernels one by one, in one process or in several that share states. */
#ifndef EC_CL_COMPILE_RUN_H
#define EC_CL_COMPILE_RUN_H

#include <stdatomic.h>

#include "cl/compile_job.h"

enum { EC_COMPILE_OPEN, EC_COMPILE_TAKEN, EC_COMPILE_DONE }; /* nobody compiles it; somebody does, or did when its process ended; it is in the
                                                              * driver's cache */

/* In memory that the processes share. */
typedef struct ec_compile_states {
    atomic_uchar programs[EC_COMPILE_PROGRAMS], kernels[EC_COMPILE_KERNELS];
} ec_compile_states;

/* Maps the states of the first job, which are at the start of a file in memory, before the jobs. NULL if it cannot be mapped. */
ec_compile_states *ec_compile_states_map(int file);
void ec_compile_states_unmap(ec_compile_states *states); /* NULL is fine */

typedef struct ec_compile_run {
    ec_cl *cl;
    const ec_compile_job *job;
    ec_compile_states *states;
    cl_program programs[EC_COMPILE_PROGRAMS]; /* programs that were built here */
    cl_mem buffers[2];                        /* zeros, and the constants */
} ec_compile_run;

/* Begins a run, which is to be ended, on failure too. What it points at has to stay. */
ec_result ec_compile_run_begin(ec_cl *cl, const ec_compile_job *job, ec_compile_states *states, ec_compile_run *run, ec_error *err);
void ec_compile_run_end(ec_compile_run *run);

/* Compiles a kernel, for which it builds its program where that was not built here. */
ec_result ec_compile_run_kernel(ec_compile_run *run, uint32_t kernel, ec_error *err);

/* Compiles those of the first `count` kernels that nobody compiles, from the first on, and reports each. */
ec_result ec_compile_run_open(ec_compile_run *run, uint32_t count, void (*compiled)(uint32_t kernel), ec_error *err);

/* Compiles all kernels but those that others have taken and finish. */
ec_result ec_compile_run_all(ec_compile_run *run, void (*compiled)(uint32_t kernel), ec_error *err);

/* Compiles all kernels of a job that nobody else compiles, and marks it as done (ec_compile_job_done). */
ec_result ec_compile_job_run(ec_cl *cl, const ec_compile_job *job, ec_error *err);

/* Takes the last needed kernel that nobody compiles, and for which no program that is being built elsewhere has to be waited for. Returns false if
 * there is none. */
bool ec_compile_run_take(ec_compile_run *run, uint32_t *kernel);

/* Returns whether the first kernel_count kernels are done. */
bool ec_compile_states_are_done(const ec_compile_states *states, uint32_t kernel_count);

#endif
