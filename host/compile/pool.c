#define _GNU_SOURCE /* sched_getaffinity */
#include "compile/pool.h"

#include <fcntl.h>
#include <sched.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "cl/compiler.h"

void tell_of(char what)
{
    ssize_t ignored = write(STDOUT_FILENO, &what, 1); /* who started it may be gone */
    (void)ignored;
}

/* Whose program number it is: by a lock on that byte of standard input, the file of the jobs, which ends with its process. */
static void hold(uint32_t program, short how)
{
    struct flock lock = {.l_type = how, .l_whence = SEEK_SET, .l_start = program, .l_len = 1};
    (void)!fcntl(STDIN_FILENO, F_SETLKW, &lock);
}

static uint32_t processors(void)
{
    cpu_set_t set;
    return sched_getaffinity(0, sizeof set, &set) == 0 ? (uint32_t)CPU_COUNT(&set) : 1;
}

pool *pool_open(const ec_compile_job *job)
{
    pool *p = mmap(NULL, sizeof *p, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (p == MAP_FAILED) return NULL;
    const uint32_t most = job->kernel_count < POOL_MOST ? job->kernel_count : POOL_MOST, here = processors();
    pool_restart(p);
    p->count = here < most ? here : most;
    if (p->count == 0) p->count = 1;
    hold(job->kernels[0].program, F_WRLCK);
    return p;
}

void pool_restart(pool *p)
{
    p->count = 1;
    for (uint32_t i = 0; i < EC_COMPILE_KERNELS; i++) atomic_flag_clear(&p->begun[i]);
}

void pool_wait(const ec_compile_job *job)
{
    hold(job->kernels[0].program, F_WRLCK);
    hold(job->kernels[0].program, F_UNLCK);
}

typedef struct turn {
    pool *pool;
    const ec_compile_job *job;
    bool is_first, tells;
} turn;

/* The i-th kernel, program by program. */
static uint32_t in_order(const ec_compile_job *job, uint32_t i)
{
    for (uint32_t program = 0;; program++)
        for (uint32_t k = 0; k < job->kernel_count; k++)
            if (job->kernels[k].program == program && i-- == 0) return k;
}

/* The first process begins with the first program, which has the largest kernels, and the others with the last one, so that few build the same. */
static bool next(void *user, uint32_t *kernel)
{
    const turn *t = user;
    const uint32_t count = t->job->kernel_count;
    for (uint32_t i = 0; i < count; i++) {
        *kernel = in_order(t->job, t->is_first ? i : count - 1 - i);
        if (!atomic_flag_test_and_set(&t->pool->begun[*kernel])) return true;
    }
    return false;
}

static void building(void *user, uint32_t program, bool begins)
{
    (void)user;
    hold(program, begins ? F_WRLCK : F_UNLCK);
}

static void compiled(void *user, uint32_t kernel)
{
    const turn *t = user;
    (void)kernel;
    if (t->tells) tell_of(EC_COMPILED_KERNEL);
}

bool pool_work(pool *p, ec_cl *cl, const ec_compile_job *job, uint32_t member, bool tells)
{
    turn t = {p, job, member == 0, tells};
    const ec_compile_turns turns = {next, building, compiled, &t};
    return ec_compile_job_run(cl, job, &turns, NULL) == EC_OK;
}
