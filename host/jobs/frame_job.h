/* The identity of a frame of a sequence, or of one of several pictures: its files keep it, so that a later run knows whether they are done. */
#ifndef EC_JOBS_FRAME_JOB_H
#define EC_JOBS_FRAME_JOB_H

#include "jobs/given.h"
#include "jobs/outputs.h"
#include "jobs/render_request.h"

/* The time of a frame in seconds of the animation, and how far the camera has gone round by then, in degrees. With --orbit alone time stands still. */
static inline double ec_frame_moment(const ec_render_request *r, uint32_t frame) { return r->frames.fps > 0 ? ec_frame_seconds(&r->frames, frame) : r->choice.at; }
static inline double ec_frame_turn(const ec_render_request *r, uint32_t frame) { return r->orbit ? 360.0 * frame / r->orbit : 0; }

/* Computes the identity common to all frames: version, kernels, the contents of the scene's files (their digest) and of the environment's, and every
 * option that a picture may depend on, as given. */
ec_result ec_frames_identify(const ec_given_options *given, const ec_render_request *request, const char *files,
                             ec_identity *all, ec_error *err);
/* Computes the identity of one frame: the common one and its moment. Without frames it is the common one. */
void ec_frame_identify(const ec_identity *all, const ec_render_request *request, uint32_t frame, ec_identity *identity);

/* Returns the command that renders this frame or picture alone to the same bits; malloc'ed, NULL when out of memory. */
char *ec_frame_command(const ec_given_options *given, const ec_render_request *request, const ec_outputs *outputs, uint32_t frame);

typedef enum ec_frame_state { EC_FRAME_DONE, EC_FRAME_MISSING, EC_FRAME_DAMAGED, EC_FRAME_OTHER } ec_frame_state;
/* Tells whether its files exist, are whole and belong to this job. The worst state counts; difference says which file is damaged or another's, and
 * how. */
ec_frame_state ec_frame_look(const ec_outputs *outputs, const ec_identity *identity, char *difference, size_t size);

#define EC_FRAME_ATTRIBUTE "eclat.frame.job" /* name of the attribute in an EXR, and keyword of the text in a PNG */

#endif
