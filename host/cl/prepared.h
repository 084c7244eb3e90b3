/* Kernels that a driver compiled when eclat was built, kept beside the program: a first render may begin with them at once. A folder holds the files of the
 * driver's cache, and a list of them for each compile job, which depends on device, driver and kernels: nothing else ever fits. Inside host/cl only. */
#ifndef EC_CL_PREPARED_H
#define EC_CL_PREPARED_H

#include <stdio.h>

#include "cl/cache.h"

/* Copies a job's files into the driver's cache `driver`, as far as they are not there. Writes a line for each, "mark path", as in the lists of
 * compile_done.c. Returns false if there are none of that key, or one cannot be copied; what was copied then stays, and is whole. */
bool ec_prepared_take(const ec_cache_key *key, const char *driver, FILE *list);

/* Returns, while eclat is built, the folder that $ECLAT_PREPARE names; else NULL. */
const char *ec_prepared_target(void);

/* Copies the files of `list` from the driver's cache into that folder. */
bool ec_prepared_put(const ec_cache_key *key, const char *driver, const char *list);

#endif
