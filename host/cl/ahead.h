/* Builds programs in a thread before they are asked for, while the host prepares the data for their kernels. Takes only those that the driver finds
 * in its cache: compiling would hold up whoever needs another program sooner. Inside host/cl, and for code that knows what will be asked for. */
#ifndef EC_CL_AHEAD_H
#define EC_CL_AHEAD_H

#include <pthread.h>

#include "cl/compile_job.h"

struct ec_ahead {
    const ec_cl *cl;
    ec_compile_job job;
    pthread_t thread;
    bool is_running, is_done; /* is_done: compiled before */
    cl_program programs[EC_COMPILE_PROGRAMS];
    ec_error errors[EC_COMPILE_PROGRAMS]; /* of programs that are NULL though all were tried */
};

/* ahead_begin.c: begins with the job's programs, and takes over their sources. Programs that were built for the job before stay. Nothing happens if
 * no thread can be started, or where programs are kept (ec_cl.keeps_programs). */
void ec_ahead_begin(ec_cl *cl, ec_compile_job *job);

/* Waits for the thread, and releases what nobody has asked for. ec_cl_close does so too. */
void ec_ahead_end(ec_cl *cl);

/* Returns whether a build of this program was tried. Then *program is the caller's from here on; or it is NULL, and *err says why. Waits for the thread. */
bool ec_ahead_take(ec_cl *cl, const char *source, const char *options, cl_program *program, ec_error *err);

/* Returns whether this is the job, and was certainly compiled before. Waits for the thread. */
bool ec_ahead_is_done(const ec_cl *cl, const ec_compile_job *job);

#endif
