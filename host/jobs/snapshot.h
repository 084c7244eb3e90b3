/* Writes the picture so far to a file of its own while a render goes on. */
#ifndef EC_JOBS_SNAPSHOT_H
#define EC_JOBS_SNAPSHOT_H

#include "jobs/render_job.h"

/* Replaces the file of --snapshot by the film's picture, if that has batches that the last snapshot lacked. */
ec_result ec_snapshot_write(ec_render_job *job, const ec_film *film, const ec_past *past, ec_error *err);

#endif
