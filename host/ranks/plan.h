/* Predicts the time of a render on any number of ranks from measurements on one. */
#ifndef EC_RANKS_PLAN_H
#define EC_RANKS_PLAN_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/error.h"

#define EC_PLAN_GBIT 10.0          /* a second, between any two ranks, where nothing else is said */
#define EC_PLAN_MICROSECONDS 50.0  /* a message */

enum { EC_PLAN_RANKS_MOST = 1000000 };

typedef struct ec_plan {
    /* Measured here, in seconds. */
    double load;                   /* reading and packing the scene: rank 0 alone, once */
    double start;                  /* kernels: each rank, at the same time */
    double batch;                  /* of rendering one of mean size on this device */
    double add, add_block;         /* of taking one, or a block (batch_source.h), into the picture, and its error: rank 0 */
    uint64_t scene_bytes;          /* that go to each rank */
    uint64_t pixels, least;        /* of the picture; of a piece of a batch, at least */
    double batches;                /* of the whole job */
    bool batches_foretold;         /* from the pilot, for an error target */
    double samples;                /* a pixel, of a batch in the mean */
    uint32_t replicates, feature_sets; /* sets: where all batches bring first-hit features */
    /* Assumed. */
    double gbit, microseconds;
    uint32_t ranks;                /* the most that are asked for */
} ec_plan;

typedef struct ec_plan_row {
    uint32_t ranks;
    double seconds;
    double efficiency;             /* seconds of one rank over ranks times these */
    double load, send, render, wait; /* of these: until the scene is there; sending it, kernels; rendering; until rank 0 has taken all in */
    double received;               /* bytes of sums, by rank 0 */
    const char *held_by;           /* what most of the loss is; "" where there is hardly any */
} ec_plan_row;

ec_plan_row ec_plan_for(const ec_plan *plan, uint32_t ranks);

/* Rows for 1, 2, 4 … and plan->ranks, with all that they rest on. */
void ec_plan_text(const ec_plan *plan, const char *device, FILE *to);
ec_result ec_plan_json(const ec_plan *plan, FILE *to, ec_error *err);

#endif
