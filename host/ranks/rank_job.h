/* A job from rank 0 to all others: what devices are given of a scene. Internal to ranks/. */
#ifndef EC_RANKS_RANK_JOB_H
#define EC_RANKS_RANK_JOB_H

#include "cl/cl.h"
#include "device/cargo.h"
#include "ranks/ranks_internal.h"

/* Rank 0: each rank says which devices it has for the job, by --device as rank 0 was given it, and all get the cargo. Then r->remotes says who
 * they are. Those without a device, or with one that may round otherwise, are warned of; one with another program fails the job. */
ec_result ec_job_send(ec_ranks *ranks, const ec_cargo *cargo, uint64_t seed, const ec_log *log, ec_error *err);

/* The others, to rank 0's word: EC_DEVICES_MOST devices at most; *count 0: none, and nothing more will come of this job. The cargo is to be freed on
 * failure too. */
ec_result ec_job_receive(ec_ranks *ranks, const ec_letter *word, ec_cargo *cargo, uint64_t *seed,
                         ec_device_info *devices, uint32_t *count, ec_error *err);

#endif
