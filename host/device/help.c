#include "device/help.h"

#include <math.h>
#include <poll.h>
#include <stdlib.h>

#include "base/clock.h"

#define SECONDS_A_KERNEL 0.4  /* at least, where the first kernels' own time says less because they were in the cache */
#define MOMENT_MS 20

struct ec_help {
    ec_compile_job job;
    ec_compile_run run;
    double begun, waited;        /* base/clock.h; seconds of waiting for the other process */
    double first;                /* seconds that the first kernels took: the fast ones take about twice as long, and two processes compile them */
    bool has_failed;
};

void ec_help_begin(ec_pipeline *p, ec_compile_job *job)
{
    ec_help *h = p->compiler.states ? calloc(1, sizeof *h) : NULL;
    if (!h) {
        ec_compile_job_free(job);
        return;
    }
    h->job = *job;
    h->begun = ec_now();
    *job = (ec_compile_job){.program_count = 0};
    p->help = h;
}

void ec_help_end(ec_pipeline *p)
{
    if (!p->help) return;
    if (p->help->run.cl) ec_compile_run_end(&p->help->run);
    ec_compile_job_free(&p->help->job);
    free(p->help);
    p->help = NULL;
}

bool ec_help_is_done(const ec_pipeline *p)
{
    return p->help && p->compiler.states && ec_compile_states_are_done(p->compiler.states, p->help->job.needed);
}

/* Returns the seconds until what is needed is compiled if both processes compile. */
static double compiling_left(const ec_help *h, const ec_compile_states *states)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < h->job.needed; i++) left += atomic_load(&states->kernels[i]) != EC_COMPILE_DONE;
    const double so_far = (ec_now() - h->begun) / (h->job.needed - left + 1);
    return left * fmax(fmax(h->first / h->job.kernel_count, SECONDS_A_KERNEL), so_far);
}

/* Waits for the other process. It may have been stopped, so the waits together last no longer than all of compiling should take. */
static bool wait_a_moment(ec_pipeline *p)
{
    const double start = ec_now();
    struct pollfd told = {.fd = p->compiler.report, .events = POLLIN};
    if (told.fd < 0 || p->help->waited > p->help->first + SECONDS_A_KERNEL * p->help->job.kernel_count) return false;
    (void)poll(&told, 1, MOMENT_MS);
    p->help->waited += ec_now() - start;
    return true;
}

bool ec_help_compile(ec_pipeline *p, double seconds_left)
{
    ec_help *h = p->help;
    ec_compile_states *states = p->compiler.states;
    uint32_t kernel;
    if (!h || !states || !p->is_narrow || p->waves_until_fast || h->has_failed) return false;
    if (h->first == 0) h->first = ec_now() - h->begun;
    if (ec_compiler_has_ended(&p->compiler) || ec_help_is_done(p) || seconds_left < compiling_left(h, states)) return false;
    p->cl->keeps_programs = true; /* kept for the fast set */
    if (!h->run.cl) h->has_failed = ec_compile_run_begin(p->cl, &h->job, states, &h->run, NULL) != EC_OK;
    if (h->has_failed || !ec_compile_run_take(&h->run, &kernel)) return !h->has_failed && wait_a_moment(p);
    h->has_failed = ec_compile_run_kernel(&h->run, kernel, NULL) != EC_OK;
    return !h->has_failed;
}
