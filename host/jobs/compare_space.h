/* Brings two pictures into one space: both stay linear, or both become what is shown of them. */
#ifndef EC_JOBS_COMPARE_SPACE_H
#define EC_JOBS_COMPARE_SPACE_H

#include "jobs/compare_job.h"

/* Replaces values and noise of both if they are to be shown, fits the exposure and estimates A's noise as asked, and records this in the report.
 * look: in: that of the options; out: the fitted one. */
ec_result ec_compare_bring_together(ec_compare_job *job, const ec_compare_options *options, ec_look *look, ec_error *err);

static inline uint64_t ec_compare_pixels(const ec_compare_job *job)
{
    return (uint64_t)job->a.measured.width * job->a.measured.height;
}

ec_result ec_compare_no_memory(const ec_compare_job *job, ec_error *err);

#endif
