/* --frames: renders one picture after the other. */
#ifndef EC_JOBS_SEQUENCE_H
#define EC_JOBS_SEQUENCE_H

#include "jobs/frame_job.h"
#include "jobs/listener.h"
#include "jobs/render_job.h"
#include "jobs/render_request.h"
#include "ranks/ranks.h"

/* Renders the frames. given: options of the request; share: with devices; start: when the command began. Errors of the sequence are reported before
 * its first sample. A frame that fails does not stop the others, but the result is then EC_FAILED, as it is if the listener ended the job. */
ec_result ec_frames_render(const ec_listener *listener, const ec_render_request *request, ec_ranks *ranks,
                           const ec_given_options *given, ec_frame_share *share, double start, ec_error *err);

#endif
