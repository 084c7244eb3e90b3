/* Wall-clock time, processor time and the process's peak memory. */
#ifndef EC_BASE_CLOCK_H
#define EC_BASE_CLOCK_H
#include <stdint.h>
#include <time.h>

double ec_now(void);                  /* seconds, monotonic, arbitrary origin */
double ec_cpu_now(void);              /* processor seconds of this process so far, user and system, of all threads */
struct timespec ec_deadline(double seconds); /* the time `seconds` from now, for pthread_cond_timedwait */
uint64_t ec_peak_memory_bytes(void);  /* peak resident set of this process, 0 if unknown */

#endif
