/* One render from request to film. */
#ifndef EC_CLI_RENDER_JOB_H
#define EC_CLI_RENDER_JOB_H

#include "cl/cl.h"
#include "cli/console.h"
#include "cli/hash.h"
#include "cli/render_request.h"
#include "cli/write_outputs.h"
#include "film/film.h"
#include "ranks/ranks.h"
#include "report/render_report.h"

typedef struct ec_render_job {
    ec_render_request *request;
    const char *command;         /* the command line */
    ec_scene *scene;             /* owned */
    ec_ranks *ranks;             /* the other processes of an MPI job; NULL: there are none */
    ec_allies allies;            /* the same as the render has them */
    char hint[600];              /* how to go on, for who is asked to stop */
    bool takes_several;          /* devices; else a list of them is refused */
    ec_device_info devices[EC_DEVICES_MOST];
    uint32_t device_indices[EC_DEVICES_MOST], device_count;
    const char *device_why;
    ec_film film;
    ec_render_stats stats;
    double load_seconds;
    char camera_text[256];
    ec_viewpoint viewpoint;
    char environment_text[256];
    char image_sha256[EC_HASH_SIZE];
    ec_job job;                  /* what goes into checkpoints and slices; the texts are the caller's */
    ec_stored stored;            /* what is gone on from. Owned */
    char device_text[1024];      /* of all of them, each driver once */
    char *whole_command;         /* of a job that is gone on with: what would render it without a break. Owned */
    ec_console *console;
    ec_error keep_error;         /* why the last checkpoint is not there; empty: it is, or none was wanted */
} ec_render_job;

/* All that can fail early does so here: outputs, device, scene, environment, camera. */
ec_result ec_render_job_prepare(ec_render_job *job, ec_console *console, ec_error *err);

/* The same without the outputs: device, scene, environment, camera, size. */
ec_result ec_render_job_load(ec_render_job *job, ec_console *console, ec_error *err);

/* With --resume, first of all: reads the checkpoint and completes the request by it. */
ec_result ec_render_job_take_up(ec_render_job *job, int argc, char **argv, ec_error *err);

/* Which batches are taken, from what on, and what is kept on the way. Takes the film of a checkpoint over. */
ec_course ec_render_job_course(ec_render_job *job, ec_console *console);

/* Renders into job->film, with progress; Ctrl-C ends it early and well. On failure too there may be batches in the film. */
ec_result ec_render_job_run(ec_render_job *job, ec_console *console, ec_error *err);

void ec_render_job_free(ec_render_job *job); /* half-built ones are fine */

#endif
