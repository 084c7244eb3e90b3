/* Returns seconds of the program's clock. */
#ifndef EC_CLI_SECONDS_H
#define EC_CLI_SECONDS_H

#include <time.h>

static inline double ec_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
