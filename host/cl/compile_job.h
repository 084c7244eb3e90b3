/* Jobs for another process that compiles kernels: programs with their options, and the launches that they are compiled for. A driver that compiles at
 * a kernel's first launch (cl/workarounds.h) finds them in its cache afterwards. */
#ifndef EC_CL_COMPILE_JOB_H
#define EC_CL_COMPILE_JOB_H

#include <stdio.h>

#include "cl/cl.h"

typedef enum ec_compile_argument { EC_COMPILE_SCALAR, EC_COMPILE_BUFFER, EC_COMPILE_CONSTANTS } ec_compile_argument;
enum { EC_COMPILE_PROGRAMS = 4, EC_COMPILE_KERNELS = 32, EC_COMPILE_ARGUMENTS = 64 };

typedef struct ec_compile_program {
    char label[32], options[192]; /* as ec_program_build takes them */
    char *source;                 /* owned */
} ec_compile_program;

/* A kernel, launched once over `rows` of `global` items with arguments by which every item leaves at once: scalars and buffers hold zeros, but for
 * the constants. */
typedef struct ec_compile_kernel {
    char name[64];
    uint32_t program, local, rows, argument_count;
    uint64_t global;
    uint8_t arguments[EC_COMPILE_ARGUMENTS]; /* ec_compile_argument */
} ec_compile_kernel;

typedef struct ec_compile_job {
    char platform[256], device[256], driver[256]; /* which device they are for */
    char cache_dir[4096];                         /* ec_cl's; empty: the default */
    ec_compile_program programs[EC_COMPILE_PROGRAMS];
    ec_compile_kernel kernels[EC_COMPILE_KERNELS];
    uint32_t program_count, kernel_count;
    uint32_t needed;                              /* the first so many kernels are needed; the others only make renders faster that take long */
    uint8_t constants[1024];
    uint32_t constants_bytes;
} ec_compile_job;

void ec_compile_job_for(const ec_cl *cl, ec_compile_job *job); /* an empty one */
void ec_compile_job_free(ec_compile_job *job);

/* Write a job to a file, and read it. Return false if it is not whole. */
bool ec_compile_job_write(const ec_compile_job *job, FILE *to);
bool ec_compile_job_read(ec_compile_job *job, FILE *from);

/* PoCL compiles again for launches of fewer items than this: see ec_kernel_run. */
#define EC_SMALL_LAUNCH 65536
static inline bool ec_compile_is_small(const ec_compile_kernel *kernel) { return kernel->global < EC_SMALL_LAUNCH; }

/* Returns whether this job was compiled before, into the driver's cache as it is now; ec_compile_job_done notes that it was. Both use a file beside
 * the kernel cache. */
bool ec_compile_job_is_done(const ec_cl *cl, const ec_compile_job *job);
void ec_compile_job_done(const ec_cl *cl, const ec_compile_job *job);
/* Returns true while eclat is built: jobs that are done are kept for first renders, in the folder that $ECLAT_PREPARE names. */
bool ec_prepares_kernels(void);
/* ec_compile_job_is_done for where nobody has looked ahead (cl/ahead.h). mends: damaged files are set aside, with a warning. */
bool ec_compile_job_look(const ec_cl *cl, const ec_compile_job *job, bool mends);

#endif
