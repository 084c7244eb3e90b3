/* Predicts the time of a render on any number of ranks from measurements on one. */
#ifndef EC_RANKS_PLAN_H
#define EC_RANKS_PLAN_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/error.h"

#define EC_PLAN_GBIT 10.0          /* default bandwidth between any two ranks, per second */
#define EC_PLAN_MICROSECONDS 50.0  /* default latency of a message */

enum { EC_PLAN_RANKS_MOST = 1000000 };

typedef struct ec_plan {
    /* Measured here, in seconds. */
    double load;                   /* to read and pack the scene: by rank 0 alone, once */
    double start;                  /* to build kernels: by all ranks at the same time */
    double batch;                  /* to render a batch of mean size on this device */
    double add, add_block;         /* for rank 0 to add a batch, or a block of batches (batch_source.h), to the picture, and estimate its error */
    uint64_t scene_bytes;          /* sent to each rank */
    uint64_t pixels, least;        /* of the picture; least number in a piece of a batch */
    double batches;                /* number in the whole job */
    bool batches_predicted;         /* estimated by the pilot, for an error target */
    double samples;                /* per pixel, in a batch of mean size */
    uint32_t replicates, feature_sets; /* feature_sets: not 0 if all batches have first-hit features */
    /* Assumed for the network. */
    double gbit, microseconds;
    uint32_t ranks;                /* the most ranks that are asked for */
} ec_plan;

typedef struct ec_plan_row {
    uint32_t ranks;
    double seconds;
    double efficiency;             /* seconds of one rank, divided by ranks times seconds */
    double load, send, render, wait; /* parts of seconds: scene loaded; sent, kernels built; rendering; until rank 0 has added all */
    double received;               /* bytes of sums that rank 0 receives */
    const char *held_by;           /* what causes most of the loss; "" if there is hardly any */
} ec_plan_row;

ec_plan_row ec_plan_for(const ec_plan *plan, uint32_t ranks);

/* Print rows for 1, 2, 4 … and plan->ranks, with the numbers that they are based on. */
void ec_plan_text(const ec_plan *plan, const char *device, FILE *to);
ec_result ec_plan_json(const ec_plan *plan, FILE *to, ec_error *err);

#endif
