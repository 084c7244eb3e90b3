/* --plan: what more ranks would buy for a job, told from a pilot on this device. */
#ifndef EC_CLI_RENDER_PLAN_H
#define EC_CLI_RENDER_PLAN_H

#include "cli/render_job.h"

/* The job is loaded (ec_render_job_load). Prints the plan to standard output, as JSON if the request says so; no picture is written. */
ec_result ec_render_plan(ec_render_job *job, ec_console *console, ec_error *err);

#endif
