/* A picture that shows nothing is told of before it is rendered. */
#ifndef EC_JOBS_BLANK_H
#define EC_JOBS_BLANK_H

#include "jobs/render_job.h"

/* Warns where the job's camera has no surface in its view, or only such as camera rays pass through; true then. */
bool ec_warn_of_blank(const ec_render_job *job);

#endif
