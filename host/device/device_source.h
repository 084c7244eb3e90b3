/* Batches from one device. */
#ifndef EC_DEVICE_DEVICE_SOURCE_H
#define EC_DEVICE_DEVICE_SOURCE_H

#include "device/batch_source.h"
#include "device/mattes.h"
#include "device/pipeline.h"

typedef struct ec_device_source {
    ec_batch_source base;
    ec_pipeline pipeline;
    uint64_t seed;
    uint32_t replicates;
    uint32_t rows;                    /* rows that it renders, from params.film_row on */
    uint32_t unfit;                   /* values that were not finite, in batches of blocks */
    ec_mattes mattes;
    bool has_begun, has_shown;        /* a wave was rendered; a wave of the picture was, not only of a look beforehand, whose orders have no samples left */
    double first_rate;                /* samples a second of the first wave */
} ec_device_source;

/* Opens a source. spent: as for ec_pipeline_create. It must be turned to its rows before the first order, and closed even on failure. */
ec_result ec_device_source_open(ec_cl *cl, const ec_payload *payload, ec_payload *spent, uint64_t seed, ec_device_source *source,
                                ec_render_stats *stats, ec_error *err);

#endif
