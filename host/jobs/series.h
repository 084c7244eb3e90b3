/* Renders several pictures, one after the other, with one device, its kernels and its environment map. */
#ifndef EC_JOBS_SERIES_H
#define EC_JOBS_SERIES_H

#include "jobs/listener.h"
#include "jobs/entries.h"
#include "ranks/ranks.h"

/* Renders all entries, or those of the request's shard, except pictures that exist already. Errors in options and outputs are reported before the
 * first sample. A picture that fails does not stop the others, and its entry says why; the result is then EC_FAILED, as it is if the listener ended
 * the job. start: when the command began. */
ec_result ec_series_render(const ec_listener *listener, const ec_render_request *request, ec_ranks *ranks, ec_entries *entries, double start,
                           ec_error *err);

#endif
