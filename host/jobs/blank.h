/* Warns before rendering of a picture that will show nothing. */
#ifndef EC_JOBS_BLANK_H
#define EC_JOBS_BLANK_H

#include "jobs/render_job.h"

/* Warns, and returns true, if the job's camera has no surface in its view, or only surfaces that camera rays pass through. */
bool ec_warn_of_blank(const ec_render_job *job);

#endif
