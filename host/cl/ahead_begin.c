#include <stdlib.h>

#include "cl/ahead.h"
#include "cl/build_log.h"

/* The thread; it touches nothing of the device that another thread may change. */
static void *build_all(void *user)
{
    struct ec_ahead *a = user;
    a->is_done = ec_compile_job_look(a->cl, &a->job, false);
    for (uint32_t i = 0; a->is_done && i < a->job.program_count; i++) {
        const ec_compile_program *one = &a->job.programs[i];
        if (!a->programs[i]) (void)ec_program_build_source(a->cl, one->label, one->source, one->options, &a->programs[i], &a->errors[i]);
    }
    return NULL;
}

/* Takes what was built for the job before and is the same now, as for a picture of another size. Waits for the thread. */
static void take_built(ec_cl *cl, struct ec_ahead *a)
{
    for (uint32_t i = 0; i < a->job.program_count; i++)
        (void)ec_ahead_take(cl, a->job.programs[i].source, a->job.programs[i].options, &a->programs[i], &a->errors[i]);
}

void ec_ahead_begin(ec_cl *cl, ec_compile_job *job)
{
    struct ec_ahead *a = cl->kept_count || cl->cache != EC_CACHE_AUTO || ec_build_log_wanted() ? NULL : calloc(1, sizeof *a);
    if (a) {
        a->cl = cl;
        a->job = *job;
        job->program_count = 0;
        take_built(cl, a);
    }
    ec_ahead_end(cl);
    if (!a) return;
    a->is_running = pthread_create(&a->thread, NULL, build_all, a) == 0;
    cl->ahead = a;
    if (!a->is_running) ec_ahead_end(cl);
}
