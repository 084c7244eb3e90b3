/* A process that compiles a job (compile_job.h) beside this one, by the program eclat-compile. */
#ifndef EC_CL_COMPILER_H
#define EC_CL_COMPILER_H

#include "cl/compile_run.h"

typedef struct ec_compiler {
    int report;               /* descriptor of what it tells; -1: there is none, or it has ended */
    uint32_t compiled, count; /* kernels */
    bool is_whole;            /* all of the first job, without an error */
    ec_compile_states *states; /* of the first job; NULL: nobody can take part in it */
} ec_compiler;

/* Has the first job compiled, which is waited for, and then the others, for renders to come, when the machine has nothing better to do. Fails where
 * the program is not there or cannot be started. */
ec_result ec_compiler_start(const ec_compile_job *const *jobs, uint32_t count, ec_compiler *compiler, ec_error *err);

/* Takes in what it has told since; true once it has ended. Never waits. */
bool ec_compiler_has_ended(ec_compiler *compiler);

/* Lets go of it: it goes on to its end, so that the next render finds what it makes. */
void ec_compiler_leave(ec_compiler *compiler);

/* What eclat-compile tells, a byte each, in any order but for the end. */
#define EC_COMPILED_KERNEL 'k'
#define EC_COMPILED_ALL 'e'

#endif
