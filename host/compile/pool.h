/* Processes that compile the kernels of one job together. */
#ifndef EC_COMPILE_POOL_H
#define EC_COMPILE_POOL_H

#include <stdatomic.h>

#include "cl/compile_job.h"

enum { POOL_MOST = 3 }; /* each loads the library of its driver, which takes as long as two kernels do */

/* In memory that all of them share. */
typedef struct pool {
    uint32_t count; /* processes */
    atomic_flag begun[EC_COMPILE_KERNELS];
} pool;

/* As many as there are processors and kernels. Who calls it is the first of them. NULL: out of memory. */
pool *pool_open(const ec_compile_job *job);

/* Waits until the first of them has built its first program. */
void pool_wait(const ec_compile_job *job);

/* Compiles what nobody else has begun; false: an error. tells: of each kernel, on standard output. */
bool pool_work(pool *p, ec_cl *cl, const ec_compile_job *job, uint32_t member, bool tells);

/* Nothing has begun any more, and who calls it is alone. */
void pool_restart(pool *p);

/* To who has started this process: EC_COMPILED_KERNEL or EC_COMPILED_ALL. */
void tell_of(char what);

#endif
