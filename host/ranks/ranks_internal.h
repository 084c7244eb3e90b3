/* What ranks say to one another. Internal to ranks/. */
#ifndef EC_RANKS_RANKS_INTERNAL_H
#define EC_RANKS_RANKS_INTERNAL_H

#include <pthread.h>

#include "ranks/post.h"
#include "ranks/ranks.h"

struct ec_ranks {
    ec_post *post;
    int rank, size;
    pthread_mutex_t lock;
    uint32_t last_box;  /* that was given to a result; with the lock */
    const char *device; /* --device */
    struct ec_remote *remotes; /* its children as sources */
    uint32_t remote_count;
};

/* Boxes: the parent's word, and the answers; its orders; and from then on one for the result of each order. */
enum { EC_BOX_WORD, EC_BOX_ORDERS, EC_BOX_RESULTS };

/* From the root down: here is a job, and answers come up; then it is broadcast (job.c). Or: that was all. */
enum { EC_WORD_JOB, EC_WORD_HOME };
enum { EC_JOB_PROGRAM };

/* A parent to one: positions [from, to) of batch `index` (batch_source.h); body: that part of the list, 4 bytes each, if there is one. Or: the job is
 * over; what is under way is given up. */
enum { EC_ORDER_BATCH, EC_ORDER_END };
enum { EC_ORDER_BOX, EC_ORDER_INDEX, EC_ORDER_FROM, EC_ORDER_TO, EC_ORDER_FEATURES };

/* Its answer: 12 bytes a position, its mean over the batch's samples, then 32 a position of features if they were asked for. Of a failure: a text. */
enum { EC_RESULT_BATCH, EC_RESULT_FAILURE };
enum { EC_RESULT_RAYS, EC_RESULT_LEAST, EC_RESULT_INVALID }; /* the last by ec_stage */

#endif
