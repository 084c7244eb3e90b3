/* Makes blocks of batches from batches, or from smaller blocks. */
#ifndef EC_DEVICE_FOLD_H
#define EC_DEVICE_FOLD_H

#include "film/parts.h"
#include "device/batch_source.h"

/* The most batches that are sent as one sum. */
#define EC_BLOCK_MOST (EC_FILM_FIRST * EC_FILM_RADIX)

/* Returns how many batches each part of a block has: parts are batches, or smaller blocks. */
static inline uint32_t ec_fold_step(uint32_t batches) { return batches > EC_FILM_FIRST ? batches / EC_FILM_RADIX : 1; }

typedef struct ec_fold_parts {
    uint32_t batches;  /* each: ec_fold_step of the block */
    /* Takes one of them, as in ec_batch_source; the others are announced as those that will be ordered next. */
    ec_result (*take)(ec_batch_source *source, const ec_batch_order *order, bool *complete, ec_error *err);
    bool want_room;    /* batches need room, into which they are brought; else they are where the source says */
} ec_fold_parts;

/* Takes the parts of a block one after the other and adds them up in the order of film/parts.h: into order->sums, or else source->sums. Holds only
 * the order's positions: a batch, if there is to be room, and up to 2 sums. *unfit grows by the number of values that were not finite and count as 0.
 * What is given up is lost. */
ec_result ec_fold_block(ec_batch_source *source, const ec_batch_order *order, uint32_t replicates, const ec_fold_parts *parts,
                        uint32_t *unfit, bool *complete, ec_error *err);

#endif
