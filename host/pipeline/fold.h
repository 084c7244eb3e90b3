/* Blocks of batches from what makes batches, or smaller blocks. */
#ifndef EC_PIPELINE_FOLD_H
#define EC_PIPELINE_FOLD_H

#include "pipeline/batch_source.h"

/* The most batches that are sent as one sum. */
#define EC_BLOCK_MOST 256u

typedef struct ec_fold_parts {
    uint32_t batches;  /* each: 1, or a 16th of the block */
    /* One of them, as ec_batch_source has it; the others are told of as those that will be ordered next. */
    ec_result (*take)(ec_batch_source *source, const ec_batch_order *order, bool *complete, ec_error *err);
    bool want_room;    /* for batches, which are brought into it; else they are where the source says */
} ec_fold_parts;

/* Takes the parts of a block one after the other and adds them up in the order of film/parts.h: into order->sums, or else source->sums. All that
 * is held is of the order's positions: 12 bytes each, if there is to be room, and up to 3 sums. *unfit grows by the values that were not finite
 * and count as 0. What is given up is lost. */
ec_result ec_fold_block(ec_batch_source *source, const ec_batch_order *order, const ec_fold_parts *parts,
                        uint32_t *unfit, bool *complete, ec_error *err);

#endif
