#include "cl/ahead.h"

#include <stdlib.h>
#include <string.h>

static void wait_for(struct ec_ahead *a)
{
    if (a->is_running) pthread_join(a->thread, NULL);
    a->is_running = false;
}

void ec_ahead_end(ec_cl *cl)
{
    struct ec_ahead *a = cl->ahead;
    if (!a) return;
    wait_for(a);
    for (uint32_t i = 0; i < EC_COMPILE_PROGRAMS; i++)
        if (a->programs[i]) clReleaseProgram(a->programs[i]);
    ec_compile_job_free(&a->job);
    free(a);
    cl->ahead = NULL;
}

bool ec_ahead_take(ec_cl *cl, const char *source, const char *options, cl_program *program, ec_error *err)
{
    struct ec_ahead *a = cl->ahead;
    if (!a) return false;
    wait_for(a);
    for (uint32_t i = 0; a->is_done && i < a->job.program_count; i++) {
        if (!*a->job.programs[i].label || strcmp(options, a->job.programs[i].options) || strcmp(source, a->job.programs[i].source)) continue;
        *program = a->programs[i];
        if (!*program && err) *err = a->errors[i];
        a->programs[i] = NULL;
        *a->job.programs[i].label = 0; /* taken */
        return true;
    }
    return false;
}

/* Returns whether two jobs are the same in all that says whether one was compiled before: compile_done.c. */
static bool is_same(const ec_compile_job *a, const ec_compile_job *b)
{
    bool same = a->program_count == b->program_count && a->kernel_count == b->kernel_count;
    for (uint32_t i = 0; same && i < a->program_count; i++)
        same = !strcmp(a->programs[i].options, b->programs[i].options) && !strcmp(a->programs[i].source, b->programs[i].source);
    for (uint32_t i = 0; same && i < a->kernel_count; i++)
        same = !strcmp(a->kernels[i].name, b->kernels[i].name) && a->kernels[i].local == b->kernels[i].local &&
               ec_compile_is_small(&a->kernels[i]) == ec_compile_is_small(&b->kernels[i]);
    return same;
}

bool ec_ahead_is_done(const ec_cl *cl, const ec_compile_job *job)
{
    struct ec_ahead *a = cl->ahead;
    if (!a) return false;
    wait_for(a);
    return a->is_done && is_same(&a->job, job);
}
