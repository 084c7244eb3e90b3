/* Runs eclat-compile, a process that compiles jobs (compile_job.h) beside this one. */
#ifndef EC_CL_COMPILER_H
#define EC_CL_COMPILER_H

#include "cl/compile_run.h"

typedef struct ec_compiler {
    int report;               /* descriptor of its reports; -1: there is none, or it has ended */
    uint32_t compiled, count; /* kernels */
    bool is_whole;            /* all of the first job is compiled, without an error */
    ec_compile_states *states; /* of the first job; NULL: this process cannot take part in it */
} ec_compiler;

/* Starts compiling: the first job, which is waited for, and then the others, for renders to come, when the machine has nothing better to do. Fails if
 * the program is not there or cannot be started. */
ec_result ec_compiler_start(const ec_compile_job *const *jobs, uint32_t count, ec_compiler *compiler, ec_error *err);

/* Reads what it has reported since; returns true once it has ended. Never waits. */
bool ec_compiler_has_ended(ec_compiler *compiler);

/* Leaves it alone: it goes on to its end, so that the next render finds what it makes. */
void ec_compiler_leave(ec_compiler *compiler);

/* Reports of eclat-compile, a byte each, in any order except for the end. */
#define EC_COMPILED_KERNEL 'k'
#define EC_COMPILED_ALL 'e'

#endif
