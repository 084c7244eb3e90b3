/* The camera of a render: the chosen one of the scene, changed and turned by options. */
#ifndef EC_JOBS_JOB_CAMERA_H
#define EC_JOBS_JOB_CAMERA_H

#include "jobs/render_job.h"

/* Changes the camera in the job's scene and, without --size, chooses the size by its shape. */
ec_result ec_job_camera(ec_render_job *job, ec_error *err);

#endif
