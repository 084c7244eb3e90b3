/* A child and all below it as a source of batches. Internal to ranks/. */
#ifndef EC_RANKS_REMOTE_H
#define EC_RANKS_REMOTE_H

#include "render/team.h"
#include "ranks/ranks_internal.h"

typedef struct ec_remote {
    ec_batch_source base;
    ec_ranks *ranks;
    int rank;
    bool is_ready;           /* it has a device, or one below it has */
    uint32_t ready;          /* how many of them have */
    bool is_over;            /* it was told that the job is */
    char name[400];          /* "rank 3 on host: device" */
} ec_remote;

/* Child i as a member of a team, if it is ready: as ec_peers has it; user is the ec_ranks. */
bool ec_ranks_recruit(void *user, uint32_t i, ec_team_recruit *recruit);

#endif
