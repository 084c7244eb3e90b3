/* --frames: one picture after the other. */
#ifndef EC_JOBS_SEQUENCE_H
#define EC_JOBS_SEQUENCE_H

#include "jobs/frame_job.h"
#include "jobs/listener.h"
#include "jobs/render_job.h"
#include "jobs/render_request.h"
#include "ranks/ranks.h"

/* given: the options of the request; share: with devices; start: when the command began. All that can be wrong with the sequence is said
 * before its first sample. A frame that fails leaves the others; the result is EC_FAILED then, and where the listener ended it. */
ec_result ec_frames_render(const ec_listener *listener, const ec_render_request *request, ec_ranks *ranks,
                           const ec_given_options *given, ec_frame_share *share, double start, ec_error *err);

#endif
