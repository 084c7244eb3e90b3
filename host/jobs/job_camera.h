/* The camera of a render: the scene's that is asked for, as options change and turn it. */
#ifndef EC_JOBS_JOB_CAMERA_H
#define EC_JOBS_JOB_CAMERA_H

#include "jobs/render_job.h"

/* Changes the job's scene; without --size it chooses that too, by the camera's shape. */
ec_result ec_job_camera(ec_render_job *job, ec_error *err);

#endif
