/* --plan: measures a pilot on this device, and tells what more ranks would gain. */
#ifndef EC_JOBS_RENDER_PLAN_H
#define EC_JOBS_RENDER_PLAN_H

#include "jobs/render_job.h"
#include "ranks/plan.h"

/* Plans a job that is loaded (ec_render_job_load). Writes no picture. */
ec_result ec_render_plan(ec_render_job *job, ec_plan *plan, ec_error *err);

#endif
