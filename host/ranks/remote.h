/* Another rank as a source of batches, for rank 0. Internal to ranks/. */
#ifndef EC_RANKS_REMOTE_H
#define EC_RANKS_REMOTE_H

#include "pipeline/batch_source.h"
#include "ranks/ranks_internal.h"

typedef struct ec_remote {
    ec_batch_source base;
    ec_ranks *ranks;
    int rank;
    bool is_ready;           /* it has a device */
    bool is_over;            /* it was told that the job is */
    char name[400];          /* "rank 3 on host: device" */
} ec_remote;

/* As an ec_team_recruit opens it: user is the ec_remote. */
ec_result ec_remote_open(void *user, ec_batch_source **source, ec_error *err);

#endif
