/* A render that compiles part of its fast kernels itself. Narrow ones render so slowly that, while another process compiles, a render is over
 * sooner if its own, which has the driver's compiler in memory by then, compiles as well in place of rendering. */
#ifndef EC_DEVICE_HELP_H
#define EC_DEVICE_HELP_H

#include "device/pipeline.h"

/* Begins to help with a job, which the other process was started with and which this function takes over. */
void ec_help_begin(ec_pipeline *pipeline, ec_compile_job *job);
void ec_help_end(ec_pipeline *pipeline); /* fine without a beginning */

/* To be called between waves, where rendering with narrow kernels would go on for so many seconds: compiles one kernel, or waits a moment for the
 * other process to end the last. Returns false if rendering is better. */
bool ec_help_compile(ec_pipeline *pipeline, double seconds_left);

/* Returns whether the needed kernels are compiled, by whichever process. */
bool ec_help_is_done(const ec_pipeline *pipeline);

#endif
