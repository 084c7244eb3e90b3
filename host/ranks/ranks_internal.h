/* The messages between ranks. Internal to ranks/. */
#ifndef EC_RANKS_RANKS_INTERNAL_H
#define EC_RANKS_RANKS_INTERNAL_H

#include <pthread.h>

#include "device/cargo.h"
#include "ranks/mpi_module.h"
#include "ranks/post.h"
#include "ranks/ranks.h"
#include "render/team.h"

/* A child and all below it as a source of batches: remote.c. */
typedef struct ec_remote {
    ec_batch_source base;
    ec_ranks *ranks;
    int rank;
    bool is_ready;           /* it has a device, or one below it has */
    uint32_t ready;          /* how many of them have */
    bool is_over;            /* it was told that the job is */
    char name[400];          /* "rank 3 on host: device" */
} ec_remote;

struct ec_ranks {
    ec_ranks_head head;
    ec_post *post;
    const ec_rank_place *place; /* the post's */
    pthread_mutex_t lock;
    uint32_t last_box;  /* that was given to a result; with the lock */
    const char *device, *own; /* --device; rank 0's drivers */
    bool own_round;
    ec_remote *remotes; /* its children as sources */
    uint32_t remote_count;
};

/* host_share.c: what is this process' of its host, devices and cores; see ranks.h. */
void ec_mpi_share_devices(const ec_ranks *ranks, ec_device_info *devices, uint32_t *indices, uint32_t *count);
void ec_mpi_note_binding(const ec_device_info *devices, uint32_t count, const ec_log *log);

/* remote.c: child i as a member of a team, if it is ready: as ec_peers has it; user is the ec_ranks. */
bool ec_ranks_recruit(void *user, uint32_t i, ec_team_recruit *recruit);

/* rank_job.c: a job from rank 0 to all others, what devices are given of a scene.
 * Rank 0: each rank says which devices it has for the job, by --device as rank 0 was given it, and all get the cargo. Then r->remotes says who
 * they are. Those without a device, or with one that may round otherwise, are warned of; one with another program fails the job. */
ec_result ec_job_send(ec_ranks *ranks, const ec_cargo *cargo, uint64_t seed, const ec_log *log, ec_error *err);

/* The others, to rank 0's word: EC_DEVICES_MOST devices at most; *count 0: none, and nothing more will come of this job. The cargo is to be freed on
 * failure too. */
ec_result ec_job_receive(ec_ranks *ranks, const ec_letter *word, ec_cargo *cargo, uint64_t *seed,
                         ec_device_info *devices, uint32_t *count, ec_error *err);

/* serve.c */
ec_result ec_mpi_serve(ec_ranks *ranks, const ec_log *log, ec_error *err);

/* Boxes: the parent's word, and the answers; the scene; its orders; and from then on one for the result of each order. */
enum { EC_BOX_WORD, EC_BOX_SCENE, EC_BOX_ORDERS, EC_BOX_RESULTS };

/* From the root down: here is a job, and answers come up; then it is spread (rank_job.c). Or: that was all, which comes up too, with whether anybody
 * was lost; and then down again, over all ranks. */
enum { EC_WORD_JOB, EC_WORD_HOME, EC_WORD_OVER };
enum { EC_END_LOST };
enum { EC_JOB_PROGRAM, EC_JOB_ROUNDS }; /* its text: rank 0's drivers; then --device, if it was given */

/* A parent to one: positions [from, to) of batch `index`, or of a block of so many from there on (batch_source.h); body: that part of the
 * list, EC_LIST_WORDS each, if there is one. The limit goes as the bits of its float. Or: the job is over; what is under way is given up. */
enum { EC_ORDER_BATCH, EC_ORDER_END };
enum { EC_ORDER_BOX, EC_ORDER_INDEX, EC_ORDER_BATCHES, EC_ORDER_FROM, EC_ORDER_TO, EC_ORDER_FEATURES, EC_ORDER_CUT, EC_ORDER_SAMPLES, EC_ORDER_LIMIT, EC_ORDER_LIGHT };

/* Its answer: EC_BATCH_FIELDS a position, then EC_AOV_FIELDS a position of features if they were asked for; of a block the sums
 * (ec_sums_in). Of a failure: a text. */
enum { EC_RESULT_BATCH, EC_RESULT_FAILURE };
enum { EC_RESULT_RAYS, EC_RESULT_LEAST, EC_RESULT_INVALID }; /* the last by ec_stage */

#endif
