/* eclat-compile: reads jobs (cl/compile_job.h) from standard input, compiles their kernels into the driver's cache, and reports each on standard
 * output. The library starts it for drivers that compile under one lock for the whole process. It outlives the process that started it. */
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include "cl/cache.h"
#include "cl/compiler.h"

enum { LATER = 10, LOWEST = 19 }; /* nice values: 10 has a tenth of the weight of a render */

/* Lowers the priority. A session of its own gets one share of the processors as a whole, if the system groups processes by sessions (sched(7),
 * autogroup). */
static void give_way(int priority)
{
    const int group = open("/proc/self/autogroup", O_WRONLY | O_CLOEXEC);
    char text[8];
    const int size = snprintf(text, sizeof text, "%d", priority);
    (void)!setpriority(PRIO_PROCESS, 0, priority);
    if (group < 0) return; /* the system has no groups */
    (void)!write(group, text, (size_t)size);
    close(group);
}

static void tell(char what)
{
    ssize_t ignored = write(STDOUT_FILENO, &what, 1); /* the process that started it may be gone */
    (void)ignored;
}

static void compiled(uint32_t kernel)
{
    (void)kernel;
    tell(EC_COMPILED_KERNEL);
}

/* Takes a lock, so that one process compiles at a time, and the next one finds the kernels compiled. Returns -1 if there is no lock or, without
 * `waits`, if another process has it. */
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

static bool find_device(const ec_compile_job *job, ec_device_info *info)
{
    ec_device_info *devices;
    uint32_t count;
    bool is_there = false;
    if (ec_devices_list(&devices, &count, NULL) != EC_OK) return false;
    for (uint32_t i = 0; i < count && !is_there; i++) {
        is_there = !strcmp(devices[i].platform_name, job->platform) && !strcmp(devices[i].name, job->device) && !strcmp(devices[i].driver, job->driver);
        if (is_there) *info = devices[i];
    }
    free(devices);
    return is_there;
}

static bool run(ec_cl *cl, const ec_compile_job *job, ec_compile_states *states)
{
    ec_compile_run run;
    ec_result result = ec_compile_run_begin(cl, job, states, &run, NULL);
    if (result == EC_OK) result = ec_compile_run_open(&run, job->needed, compiled, NULL);
    give_way(LATER); /* the render goes on without the remaining kernels */
    if (result == EC_OK) result = ec_compile_run_all(&run, compiled, NULL);
    ec_compile_run_end(&run);
    if (result == EC_OK) ec_compile_job_done(cl, job);
    return result == EC_OK;
}

/* Compiles the kernels of a job; somebody waits for the first one only. */
static int compile_all(ec_compile_job *job, ec_compile_states *states)
{
    ec_device_info info;
    ec_cl cl;
    int turn = lock(job->cache_dir, "compiling", true);
    if (!find_device(job, &info) || ec_cl_open(&info, &cl, NULL) != EC_OK) return 1;
    if (*job->cache_dir) cl.cache_dir = job->cache_dir;
    if (!run(&cl, job, states)) return 1;
    tell(EC_COMPILED_ALL);
    if (turn >= 0) close(turn);
    turn = lock(job->cache_dir, "compiling-ahead", false);
    give_way(LOWEST);
    while (turn >= 0 && ec_compile_job_read(job, stdin))
        if (!ec_compile_job_is_done(&cl, job) && ec_compile_job_run(&cl, job, NULL) != EC_OK) return 1;
    return 0;
}

int main(void)
{
    static ec_compile_job job;
    signal(SIGPIPE, SIG_IGN);
    ec_compile_states *states = ec_compile_states_map(STDIN_FILENO);
    if (!states || fseek(stdin, sizeof *states, SEEK_SET) != 0 || !ec_compile_job_read(&job, stdin)) return 1;
    if (fork() != 0) _exit(0); /* the waiting parent goes on; exit() would move the file position of standard input, which both share */
    setsid(); /* so that Ctrl-C reaches only the render */
    return compile_all(&job, states);
}
