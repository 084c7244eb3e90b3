/* The identity of a sequence's frame, or of one of several pictures, which its files keep, so that a later run knows whether it is done. */
#ifndef EC_JOBS_FRAME_JOB_H
#define EC_JOBS_FRAME_JOB_H

#include "jobs/given.h"
#include "jobs/outputs.h"
#include "jobs/render_request.h"

/* When a frame is shown, in seconds of the animation, and how far the camera has gone round then, in degrees. With --orbit alone time stands still. */
static inline double ec_frame_moment(const ec_render_request *r, uint32_t frame) { return r->frames.fps > 0 ? ec_frame_seconds(&r->frames, frame) : r->choice.at; }
static inline double ec_frame_turn(const ec_render_request *r, uint32_t frame) { return r->orbit ? 360.0 * frame / r->orbit : 0; }

/* The identity of all frames: version, kernels, the bytes of the scene's files (their digest) and of the environment's, and every option that a
 * picture may depend on, as it was given. */
ec_result ec_frames_identify(const ec_given_options *given, const ec_render_request *request, const char *files,
                             ec_identity *all, ec_error *err);
/* One of them: the same at its moment. Without frames, the same. */
void ec_frame_identify(const ec_identity *all, const ec_render_request *request, uint32_t frame, ec_identity *identity);

/* The command that renders this frame, or picture, alone to the same bits; malloc'ed, NULL when out of memory. */
char *ec_frame_command(const ec_given_options *given, const ec_render_request *request, const ec_outputs *outputs, uint32_t frame);

typedef enum ec_frame_state { EC_FRAME_DONE, EC_FRAME_MISSING, EC_FRAME_DAMAGED, EC_FRAME_OTHER } ec_frame_state;
/* Are its files there, as they were written and of this job? The worst of them counts; difference says which one is
 * damaged or other, and how. */
ec_frame_state ec_frame_look(const ec_outputs *outputs, const ec_identity *identity, char *difference, size_t size);

#define EC_FRAME_ATTRIBUTE "eclat.frame.job" /* of an EXR, and the keyword of a text in a PNG */

#endif
