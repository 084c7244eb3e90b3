/* argv in, exit code out; everything else is in cli/. */
#define _GNU_SOURCE /* for pthread_setattr_default_np */
#include <fcntl.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "cli/cli.h"
#include "cli/stop.h"

/* Opens closed standard descriptors, so that no picture is opened on one to which a message then goes. They are opened in the wrong mode on purpose,
 * so that using the stream still fails. */
static void occupy_standard_descriptors(void)
{
    for (int fd = 0; fd <= 2; fd++)
        if (fcntl(fd, F_GETFD) < 0) open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
}

/* Tunes malloc. PoCL's compiler allocates from several threads; with an arena for each, memory freed by one cannot be used by the others (a million
 * triangles, cold start: 610 MB at the peak instead of 565). Blocks of up to 16 MB come from the heap, which keeps up to 64 MB of free memory: if it
 * were returned at once, as by default from 128 KiB on, most memory of a start would be touched anew in each of its steps, at a page fault for each 4
 * KiB. Small blocks of a launch, which drivers allocate and free some hundred times a wave, are joined with their neighbours when freed: joining them
 * all at the next large block took a tenth of the host's time. */
static void keep_memory(void)
{
#ifdef __GLIBC__
    mallopt(M_ARENA_MAX, 1);
    mallopt(M_MXFAST, 0);
    mallopt(M_MMAP_THRESHOLD, 16 << 20);
    mallopt(M_TRIM_THRESHOLD, 64 << 20);
#endif
}

/* Removes an empty POCL_CACHE_DIR, for which PoCL ends the process. */
static void drop_empty_folder(void)
{
    const char *folder = getenv("POCL_CACHE_DIR");
    if (folder && !*folder) unsetenv("POCL_CACHE_DIR");
}

static struct {
    int argc, code;
    char **argv;
} command;

static void *run(void *unused)
{
    (void)unused;
    command.code = ec_cli_main(command.argc, command.argv);
    return NULL;
}

#define STACK_LEAST (8ul << 20) /* the usual default; drivers' compilers silently overrun much smaller ones */

/* If the limit is smaller, gives all threads this much, and runs the command in a thread of its own. Returns false if nothing was run. */
static bool run_with_room(void)
{
    struct rlimit limit;
    pthread_attr_t attributes;
    pthread_t thread;
    if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= STACK_LEAST) return false;
    if (pthread_attr_init(&attributes) != 0) return false;
    bool is_done = pthread_attr_setstacksize(&attributes, STACK_LEAST) == 0;
#ifdef __GLIBC__
    is_done = is_done && pthread_setattr_default_np(&attributes) == 0;
#endif
    is_done = is_done && pthread_create(&thread, &attributes, run, NULL) == 0 && pthread_join(thread, NULL) == 0;
    pthread_attr_destroy(&attributes);
    return is_done;
}

int main(int argc, char **argv)
{
    occupy_standard_descriptors();
    keep_memory();
    drop_empty_folder();
    ec_stop_watch_signals();
    signal(SIGPIPE, SIG_IGN); /* a closed pipe is an error to report, after the picture is safe */
    ec_stop_ignore_file_size();
    command.argc = argc;
    command.argv = argv;
    if (!run_with_room()) run(NULL);
    return command.code;
}
