/* argv in, exit code out; everything else is in cli/. */
#include <fcntl.h>
#include <stdlib.h>
#include <signal.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "cli/cli.h"
#include "cli/stop.h"

/* A picture must never be opened on a descriptor that the caller closed and that a message then goes to. The mode is
 * the wrong one on purpose, so that using the stream still fails. */
static void occupy_standard_descriptors(void)
{
    for (int fd = 0; fd <= 2; fd++)
        if (fcntl(fd, F_GETFD) < 0) open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
}

/* PoCL's compiler allocates from several threads; with an arena each, what one frees the others cannot use (a million
 * triangles, cold start: 610 MB at the peak instead of 565). A fixed threshold gives large blocks back at once. */
static void keep_memory_small(void)
{
#ifdef __GLIBC__
    mallopt(M_ARENA_MAX, 1);
    mallopt(M_MMAP_THRESHOLD, 128 * 1024);
#endif
}

int main(int argc, char **argv)
{
    occupy_standard_descriptors();
    keep_memory_small();
    ec_stop_watch_signals();
    signal(SIGPIPE, SIG_IGN); /* a closed pipe is an error to report, after the picture is safe */
    ec_stop_ignore_file_size();
    return ec_cli_main(argc, argv);
}
