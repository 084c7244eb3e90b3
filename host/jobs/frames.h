/* --frames A:B[:STEP]: which frames, and when they are shown. */
#ifndef EC_JOBS_FRAMES_H
#define EC_JOBS_FRAMES_H

#include "jobs/outputs.h"

#define EC_FRAME_MOST 9999999

typedef struct ec_frame_range {
    bool given;
    uint32_t first, last, step; /* last is one of them, where a step leads there */
    double fps;                 /* frames a second; frame F is shown at F / fps seconds */
} ec_frame_range;

/* "7", "0:9", "0:9:3". EC_USAGE for anything else; leaves fps. */
ec_result ec_frame_range_parse(const char *option, const char *text, ec_frame_range *range, ec_error *err);

static inline uint32_t ec_frame_count(const ec_frame_range *r) { return (r->last - r->first) / r->step + 1; }
static inline uint32_t ec_frame_number(const ec_frame_range *r, uint32_t i) { return r->first + i * r->step; }
static inline double ec_frame_seconds(const ec_frame_range *r, uint32_t frame) { return frame / r->fps; }

/* The sequence's outputs for one frame, in whose names one %d, or %04d and the like, stands for its number, and %% for a per cent sign. several:
 * frames, so that a name without a place for the number will not do. EC_USAGE for a pattern that is none. */
ec_result ec_frame_outputs(const ec_outputs *patterns, uint32_t frame, bool several, ec_outputs *outputs, ec_error *err);

#endif
