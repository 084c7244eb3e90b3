/* Reads from a wave's slots which nodes and materials its samples have met. */
#ifndef EC_DEVICE_MATTES_H
#define EC_DEVICE_MATTES_H

#include "device/pipeline.h"
#include "film/matte_log.h"

typedef struct ec_mattes {
    ec_matte_log met;   /* what the batch under way, or the piece of one, has met */
    float *nodes;       /* room for two numbers of each sample of a wave */
    uint64_t room;
} ec_mattes;

/* Reads a wave of `count` positions from `first` on, which are entries of a list or pixels of the rows that the pipeline renders. */
ec_result ec_mattes_read(ec_mattes *mattes, const ec_pipeline *p, bool is_list, uint32_t first, uint32_t count, ec_error *err);

/* Moves all that has been met to `log`; called once the batch is complete. */
ec_result ec_mattes_tell(ec_mattes *mattes, ec_matte_log *log, ec_error *err);

void ec_mattes_free(ec_mattes *mattes);

#endif
