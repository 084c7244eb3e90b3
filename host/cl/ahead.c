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

cl_program ec_ahead_take(ec_cl *cl, const char *source, const char *options)
{
    struct ec_ahead *a = cl->ahead;
    cl_program found = NULL;
    if (!a) return NULL;
    wait_for(a);
    for (uint32_t i = 0; i < a->job.program_count && !found; i++) {
        if (!a->programs[i] || strcmp(options, a->job.programs[i].options) || strcmp(source, a->job.programs[i].source)) continue;
        found = a->programs[i];
        a->programs[i] = NULL;
    }
    return found;
}

/* All that says whether a job was compiled before: compile_done.c. */
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

bool ec_ahead_knows(const ec_cl *cl, const ec_compile_job *job, bool *is_done)
{
    struct ec_ahead *a = cl->ahead;
    if (!a) return false;
    wait_for(a);
    if (!is_same(&a->job, job)) return false;
    *is_done = a->is_done;
    return true;
}
