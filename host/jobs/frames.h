/* --frames A:B[:STEP]: which frames are shown, and when. */
#ifndef EC_JOBS_FRAMES_H
#define EC_JOBS_FRAMES_H

#include "jobs/outputs.h"

#define EC_FRAME_MOST 9999999

typedef struct ec_frame_range {
    bool given;
    uint32_t first, last, step; /* last belongs to the range only if a step meets it */
    double fps;                 /* frames per second; frame F is shown at F / fps seconds */
} ec_frame_range;

/* Parses "7", "0:9" or "0:9:3"; leaves fps unchanged. Returns EC_USAGE for anything else. */
ec_result ec_frame_range_parse(const char *option, const char *text, ec_frame_range *range, ec_error *err);

static inline uint32_t ec_frame_count(const ec_frame_range *r) { return (r->last - r->first) / r->step + 1; }
static inline uint32_t ec_frame_number(const ec_frame_range *r, uint32_t i) { return r->first + i * r->step; }
static inline double ec_frame_seconds(const ec_frame_range *r, uint32_t frame) { return frame / r->fps; }

/* Makes the outputs of one frame from patterns, in which one %d, %04d or the like stands for its number, and %% for a per cent sign. several: there
 * are several frames, so that every name needs a place for the number. Returns EC_USAGE for an invalid pattern. */
ec_result ec_frame_outputs(const ec_outputs *patterns, uint32_t frame, bool several, ec_outputs *outputs, ec_error *err);

#endif
