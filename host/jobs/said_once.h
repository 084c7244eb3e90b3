/* A log that says a note or a warning once. */
#ifndef EC_JOBS_SAID_ONCE_H
#define EC_JOBS_SAID_ONCE_H

#include <stdint.h>

#include "base/error.h"

typedef struct ec_said_once {
    ec_log log;        /* where it goes */
    uint64_t said[64]; /* hashes of what was said */
    int count;
} ec_said_once;

ec_log ec_said_once_log(ec_said_once *said); /* valid as long as it */

#endif
