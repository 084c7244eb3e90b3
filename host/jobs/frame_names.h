/* Names of a sequence's files: one %d, or %04d and the like, stands for the frame's number, and %% for a per cent sign. */
#ifndef EC_JOBS_FRAME_NAMES_H
#define EC_JOBS_FRAME_NAMES_H

#include "jobs/outputs.h"

/* The sequence's outputs for one frame. several: frames, so that a name without a place for the number will not do. EC_USAGE for a pattern
 * that is none. */
ec_result ec_frame_outputs(const ec_outputs *patterns, uint32_t frame, bool several, ec_outputs *outputs, ec_error *err);

#endif
