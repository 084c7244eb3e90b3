/* argv in, exit code out; everything else is in cli/. */
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include "cli/cli.h"

/* A picture must never be opened on a descriptor that the caller closed and that a message then goes to. The mode is
 * the wrong one on purpose, so that using the stream still fails. */
static void occupy_standard_descriptors(void)
{
    for (int fd = 0; fd <= 2; fd++)
        if (fcntl(fd, F_GETFD) < 0) open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
}

int main(int argc, char **argv)
{
    occupy_standard_descriptors();
    signal(SIGPIPE, SIG_IGN); /* a closed pipe is an error to report, after the picture is safe */
    return ec_cli_main(argc, argv);
}
