/* A command line that is wrong: exit code 2. */
#ifndef EC_JOBS_USAGE_H
#define EC_JOBS_USAGE_H

#include "base/error.h"

/* Like ec_fail, but returns EC_USAGE. */
#define ec_usage(...) (ec_fail(__VA_ARGS__), EC_USAGE)

#endif
