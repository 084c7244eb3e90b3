#define _POSIX_C_SOURCE 200809L
#include "base/clock.h"

#include <sys/resource.h>
#include <time.h>

double ec_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

uint64_t ec_peak_memory_bytes(void)
{
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage)) return 0;
    return (uint64_t)usage.ru_maxrss * 1024u; /* Linux reports KiB */
}
