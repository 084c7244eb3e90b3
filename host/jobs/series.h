/* Several pictures, one after the other, with one device, its kernels and its environment map. */
#ifndef EC_JOBS_SERIES_H
#define EC_JOBS_SERIES_H

#include "jobs/listener.h"
#include "jobs/entries.h"
#include "ranks/ranks.h"

/* Renders all entries, or those of the request's shard, but for what is there already. All that can be wrong with options and outputs is said before
 * the first sample. A picture that fails leaves the others, and its entry says why it is not there; the result is EC_FAILED then, and where the listener ended it. start: when the
 * command began. */
ec_result ec_series_render(const ec_listener *listener, const ec_render_request *request, ec_ranks *ranks, ec_entries *entries, double start,
                           ec_error *err);

#endif
