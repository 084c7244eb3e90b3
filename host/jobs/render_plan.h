/* --plan: what more ranks would buy for a job, told from a pilot on this device. */
#ifndef EC_JOBS_RENDER_PLAN_H
#define EC_JOBS_RENDER_PLAN_H

#include "jobs/render_job.h"
#include "ranks/plan.h"

/* The job is loaded (ec_render_job_load). No picture is written. */
ec_result ec_render_plan(ec_render_job *job, ec_plan *plan, ec_error *err);

#endif
