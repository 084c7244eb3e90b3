/* Where batches come from: one device that renders one batch at a time. It knows no film, no limits and no other source; a batch's
 * numbers depend on its index alone, so that any source may take any batch. */
#ifndef EC_PIPELINE_BATCH_SOURCE_H
#define EC_PIPELINE_BATCH_SOURCE_H

#include "pipeline/pipeline.h"

typedef struct ec_batch_source {
    ec_pipeline pipeline;
    uint64_t seed;
    float *mean;                      /* 3 a pixel: of the batch taken last. Owned */
    uint32_t invalid[EC_STAGE_COUNT]; /* samples dropped so far, by ec_stage */
    uint32_t rows;                    /* that it renders: from params.film_row on */
    bool has_begun;
} ec_batch_source;

typedef struct ec_batch_order {
    uint32_t index;                   /* of the batch, in the whole job */
    const uint32_t *list;             /* pixel numbers, those of one pass of an adaptive render; NULL: all pixels */
    uint32_t count;                   /* of these */
    uint32_t done;                    /* so many of them are done before: mean holds what they came to */
    bool with_features;               /* first-hit features too, for ec_batch_source_features */
    /* Asked between waves, with the pixels that are done, the first time when the device has done them; false gives the batch up. */
    bool (*go_on)(void *user, uint32_t done);
    void *user;
} ec_batch_order;

/* What mean[3 i] holds of a pixel that a batch which was given up has not reached: radiance is never negative. */
#define EC_NOT_REACHED (-1.0f)

/* The cargo is spent. */
ec_result ec_batch_source_open(ec_cl *cl, ec_cargo *cargo, uint64_t seed, ec_batch_source *source, ec_render_stats *stats, ec_error *err);

/* Before the first batch: which rows of the picture the next ones are of, all of them or a strip (strips.h). A film begins with them. */
ec_result ec_batch_source_turn_to(ec_batch_source *source, uint32_t first_row, uint32_t rows, ec_error *err);
void ec_batch_source_close(ec_batch_source *source); /* zero-initialised is fine */

/* *complete: false where go_on said no; pixels not reached then hold what was there before, in a first batch EC_NOT_REACHED. */
ec_result ec_batch_source_take(ec_batch_source *source, const ec_batch_order *order, bool *complete, ec_error *err);

/* Between two waves: mean becomes what the batch under way has come to so far, and invalid too. */
ec_result ec_batch_source_look(ec_batch_source *source, const ec_batch_order *order, ec_error *err);

/* Of the batch taken last, 8 floats a pixel, malloc'ed: ec_film's aov. */
ec_result ec_batch_source_features(ec_batch_source *source, float **aov, ec_error *err);

#endif
