/* A command line that is wrong: exit code 2. */
#ifndef EC_JOBS_USAGE_H
#define EC_JOBS_USAGE_H

#include "base/error.h"

/* Like ec_fail, but returns EC_USAGE. */
ec_result ec_usage(ec_error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
