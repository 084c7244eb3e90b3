/* Messages between ranks. Internal to ranks/. */
#ifndef EC_RANKS_RANKS_INTERNAL_H
#define EC_RANKS_RANKS_INTERNAL_H

#include <pthread.h>

#include "device/payload.h"
#include "ranks/mpi_module.h"
#include "ranks/transport.h"
#include "ranks/ranks.h"
#include "render/team.h"

/* A child and all ranks below it, as a source of batches: remote.c. */
typedef struct ec_remote {
    ec_batch_source base;
    ec_ranks *ranks;
    int rank;
    bool is_ready;           /* it or a rank below it has a device */
    uint32_t ready;          /* number of these */
    bool is_over;            /* it was told that the job is over */
    char name[400];          /* e.g. "rank 3 on host: device" */
} ec_remote;

struct ec_ranks {
    ec_ranks_head head;
    ec_transport *transport;
    const ec_rank_place *place; /* belongs to the transport */
    pthread_mutex_t lock;
    uint32_t last_box;  /* last box used for a result; guarded by the lock */
    const char *device, *own; /* --device; drivers of rank 0 */
    bool own_round;
    ec_remote *remotes; /* its children, as sources */
    uint32_t remote_count;
};

/* host_share.c: the share of this process in its host's devices and cores; see ranks.h. */
void ec_mpi_share_devices(const ec_ranks *ranks, ec_device_info *devices, uint32_t *indices, uint32_t *count);
void ec_mpi_note_binding(const ec_device_info *devices, uint32_t count, const ec_log *log);

/* remote.c: adds child i to a team, if it is ready, as ec_peers demands; user is the ec_ranks. */
bool ec_ranks_candidate(void *user, uint32_t i, ec_team_candidate *candidate);

/* rank_job.c: sends a job from rank 0 to all others: what devices need of a scene.
 * On rank 0: asks each rank for its devices, by --device as given to rank 0, and sends the payload to all. Then r->remotes is filled in. Warns of ranks
 * without a device, or with one that may round differently; fails if one runs another program. */
ec_result ec_job_send(ec_ranks *ranks, const ec_payload *payload, uint64_t seed, const ec_log *log, ec_error *err);

/* On the others, after rank 0's word: finds at most EC_DEVICES_MOST devices and receives the payload; *count 0: this rank takes no part in the job. The
 * payload must be freed on failure too. */
ec_result ec_job_receive(ec_ranks *ranks, const ec_message *word, ec_payload *payload, uint64_t *seed,
                         ec_device_info *devices, uint32_t *count, ec_error *err);

/* serve.c */
ec_result ec_mpi_serve(ec_ranks *ranks, const ec_log *log, ec_error *err);

/* Boxes: the parent's words and their answers; the scene; orders; and from then on one for the result of each order. */
enum { EC_BOX_WORD, EC_BOX_SCENE, EC_BOX_ORDERS, EC_BOX_RESULTS };

/* Words from the root down. JOB: answers come up, then the job is spread (rank_job.c). HOME: everything is over; it comes up again with whether
 * anybody was lost, and then OVER goes down, for all ranks. */
enum { EC_WORD_JOB, EC_WORD_HOME, EC_WORD_OVER };
enum { EC_END_LOST };
enum { EC_JOB_PROGRAM, EC_JOB_ROUNDS }; /* text of a job: rank 0's drivers; then --device, if it was given */

/* Orders of a parent. BATCH: positions [from, to) of batch `index`, or of a block of batches that begins there (batch_source.h); body: that part of
 * the list, EC_LIST_WORDS each, if there is one. The limit is sent as the bits of its float. END: the job is over, and work in progress is abandoned. */
enum { EC_ORDER_BATCH, EC_ORDER_END };
enum { EC_ORDER_BOX, EC_ORDER_INDEX, EC_ORDER_BATCHES, EC_ORDER_FROM, EC_ORDER_TO, EC_ORDER_FEATURES, EC_ORDER_CUT, EC_ORDER_SAMPLES, EC_ORDER_LIMIT, EC_ORDER_LIGHT };

/* Answers. BATCH: EC_BATCH_FIELDS per position, then EC_AOV_FIELDS per position if features were asked for; of a block, its sums (ec_sums_in).
 * FAILURE: a text. */
enum { EC_RESULT_BATCH, EC_RESULT_FAILURE };
enum { EC_RESULT_RAYS, EC_RESULT_LEAST, EC_RESULT_INVALID }; /* INVALID: and the following ones, by ec_stage */

#endif
