/* A render that compiles part of its fast kernels itself. Narrow ones render so slowly that, while another process compiles, a render is over
 * sooner if its own, which has the driver's compiler in memory by then, compiles as well in place of rendering. */
#ifndef EC_DEVICE_HELP_H
#define EC_DEVICE_HELP_H

#include "device/pipeline.h"

/* The other process was started with this job, which is this function's from now on. */
void ec_help_begin(ec_pipeline *pipeline, ec_compile_job *job);
void ec_help_end(ec_pipeline *pipeline); /* fine without a beginning */

/* Between waves, where rendering with narrow kernels would go on for so many seconds: compiles one kernel, or waits a moment for the other
 * process to end the last. False: to render is better. */
bool ec_help_compile(ec_pipeline *pipeline, double seconds_left);

/* Are the needed kernels compiled, whoever did it? */
bool ec_help_is_done(const ec_pipeline *pipeline);

#endif
