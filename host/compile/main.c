/* eclat-compile: compiles the kernels of jobs (cl/compile_job.h) on standard input into the driver's cache, and tells of each on standard output. The
 * library starts it where a driver compiles under one lock for its whole process. It outlives who started it. */
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cl/cache.h"
#include "cl/compiler.h"
#include "compile/pool.h"

#define LOWEST 19 /* of priorities */

/* One process at a time: whoever comes second finds kernels compiled. -1: no lock, or where nobody waits for it, somebody else's. */
static int lock(const char *cache_dir, const char *name, bool waits)
{
    char folder[PATH_MAX], path[PATH_MAX + 32];
    if (!ec_cache_folder(*cache_dir ? cache_dir : NULL, folder, sizeof folder) || !ec_cache_make_folder(folder)) return -1;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    const int fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (fd < 0 || flock(fd, waits ? LOCK_EX : LOCK_EX | LOCK_NB) == 0) return fd;
    close(fd);
    return -1;
}

static bool open_device(const ec_compile_job *job, ec_cl *cl)
{
    ec_device_info *devices, *found = NULL;
    uint32_t count;
    if (ec_devices_list(&devices, &count, NULL) != EC_OK) return false;
    for (uint32_t i = 0; i < count && !found; i++)
        if (!strcmp(devices[i].platform_name, job->platform) && !strcmp(devices[i].name, job->device) && !strcmp(devices[i].driver, job->driver)) found = &devices[i];
    const bool is_open = found && ec_cl_open(found, cl, NULL) == EC_OK;
    free(devices);
    if (is_open && *job->cache_dir) cl->cache_dir = job->cache_dir;
    return is_open;
}

/* A process that helps with the first job begins once its first program is built: until then a render beside it compiles what it begins with. */
static int help(pool *p, const ec_compile_job *job, uint32_t member)
{
    ec_cl cl;
    pool_wait(job);
    return open_device(job, &cl) && pool_work(p, &cl, job, member, true) ? 0 : 1;
}

/* By as many processes as are of use, which part before a device is open. */
static bool compile_first(pool *p, ec_cl *cl, const ec_compile_job *job)
{
    pid_t helpers[POOL_MOST];
    for (uint32_t i = 1; i < p->count; i++)
        if ((helpers[i] = fork()) == 0) _exit(help(p, job, i)); /* exit() would move the place in standard input, which all share */
    if (!open_device(job, cl)) return false;
    bool done = pool_work(p, cl, job, 0, true);
    for (uint32_t i = 1; i < p->count; i++) {
        int status = 1;
        done &= helpers[i] > 0 && waitpid(helpers[i], &status, 0) == helpers[i] && status == 0;
    }
    if (done) return true;
    pool_restart(p); /* for what a helper has left undone */
    return pool_work(p, cl, job, 0, false);
}

/* The first job is waited for; others are not. */
static int compile_all(ec_compile_job *job)
{
    ec_cl cl;
    int turn = lock(job->cache_dir, "compiling", true);
    pool *p = pool_open(job);
    if (!p || !compile_first(p, &cl, job)) return 1;
    ec_compile_job_done(&cl, job);
    tell_of(EC_COMPILED_ALL);
    if (turn >= 0) close(turn);
    turn = lock(job->cache_dir, "compiling-ahead", false);
    (void)!setpriority(PRIO_PROCESS, 0, LOWEST);
    while (turn >= 0 && ec_compile_job_read(job, stdin)) {
        if (ec_compile_job_is_done(&cl, job)) continue;
        pool_restart(p);
        if (!pool_work(p, &cl, job, 0, false)) return 1;
        ec_compile_job_done(&cl, job);
    }
    return 0;
}

int main(void)
{
    static ec_compile_job job;
    signal(SIGPIPE, SIG_IGN);
    if (!ec_compile_job_read(&job, stdin)) return 1;
    if (fork() != 0) _exit(0); /* who waits for this process goes on */
    setsid();                  /* Ctrl-C is for the render */
    return compile_all(&job);
}
