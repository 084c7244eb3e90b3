/* One render from request to film. */
#ifndef EC_JOBS_RENDER_JOB_H
#define EC_JOBS_RENDER_JOB_H

#include "gltf/reader.h"
#include "cl/cl.h"
#include "denoise/denoise.h"
#include "device/ahead.h"
#include "jobs/frame_share.h"
#include "jobs/hash.h"
#include "jobs/listener.h"
#include "jobs/render_request.h"
#include "jobs/write_rows.h"
#include "film/film.h"
#include "pack/pack.h"
#include "ranks/ranks.h"
#include "report/render_report.h"

typedef struct ec_render_job {
    ec_render_request *request;
    const ec_listener *listener; /* never NULL */
    const char *program;         /* as it was called; NULL: the job has no checkpoint */
    const char *command;         /* the command line */
    ec_scene *scene;             /* owned */
    ec_light_groups groups;      /* of the scene. Owned */
    ec_matte_names mattes;       /* likewise */
    ec_ranks *ranks;             /* the other processes of an MPI job; NULL: there are none */
    ec_peers peers;            /* the same as the render has them */
    ec_frame_share *share;       /* NULL: it is the only picture of its job */
    ec_frame_facts frame;        /* with that */
    bool takes_several;          /* devices; else a list of them is refused */
    bool is_blank;               /* its camera sees no surface */
    bool in_memory;              /* the whole film is wanted, not files */
    bool renders;                /* the scene, as soon as it is loaded: its device is opened meanwhile */
    ec_device_info devices[EC_DEVICES_MOST];
    uint32_t device_indices[EC_DEVICES_MOST], device_count;
    const char *device_why;
    ec_cl early;                 /* the device, opened while the scene is loaded; without context: it was not. Owned */
    ec_recall recall;            /* what is built on it meanwhile */
    ec_denoised denoised;        /* of the film, with options.denoise */
    ec_behind behind;            /* with a blurred background. Owned */
    ec_film film;                /* empty where the picture was rendered in strips, which are on their way to the files: */
    ec_row_writer *rows;         /* owned; NULL: no strip is complete, or the picture was rendered whole */
    ec_ocio *ocio;               /* with --ocio. Owned */
    double shadow_error;         /* with a ground that catches shadows: of its alpha (shadow.h); NaN: not known */
    ec_render_stats stats;
    ec_render_options rendered;  /* as reports have them: ec_render_job_report sets it */
    double load_seconds;         /* until devices and scene were there */
    char camera_text[256];
    ec_viewpoint viewpoint;
    char environment_text[256];
    char image_sha256[EC_HASH_SIZE];
    ec_job job;                  /* what goes into checkpoints and slices; the texts are the caller's */
    ec_stored stored;            /* the checkpoint that is resumed. Owned */
    ec_given_options before;     /* that began the job that is resumed */
    char device_text[1024];      /* their drivers: cl/workarounds.h */
    char *whole_command;         /* of a job that is resumed: what would render it without a break. Owned */
    uint32_t shot_batches;       /* of the last snapshot */
    bool has_kept;               /* a checkpoint */
    ec_error keep_error;         /* why the last one is not there; empty: it is, or none was wanted */
} ec_render_job;

/* All that can fail early does so here: outputs, device, scene, environment, camera. */
ec_result ec_render_job_prepare(ec_render_job *job, ec_error *err);

/* Part of that: may outputs and checkpoint be written, and is none an input? */
ec_result ec_render_check_files(const ec_render_request *request, ec_error *err);

/* By the request: one, or with takes_several all that it names. */
ec_result ec_render_job_find_devices(ec_render_job *job, ec_error *err);

/* Prepares all but the outputs: device, scene, environment, camera, size. */
ec_result ec_render_job_load(ec_render_job *job, ec_error *err);

/* Part of that: the environment that the request asks for, or the studio where job->scene has no light. */
ec_result ec_render_job_light(ec_render_job *job, ec_error *err);

/* With --resume, first of all: reads the checkpoint and completes the request by it. */
ec_result ec_render_job_take_up(ec_render_job *job, const ec_given_options *now, ec_error *err);

/* Which batches are taken, from what on, and what is kept on the way. Takes the film of a checkpoint over. */
ec_course ec_render_job_course(ec_render_job *job);

/* Renders into job->film; the listener may end it early and well. On failure too there may be batches in the film. */
ec_result ec_render_job_run(ec_render_job *job, ec_error *err);

/* With options.denoise: makes the film's clean picture, unless the last look at its error has. A failure leaves the film as it was. */
ec_result ec_render_job_denoise(ec_render_job *job, ec_error *err);

/* render_deliver.c: writes the film to the outputs and reports it; start: when the job, or the frame, began. */
ec_result ec_render_job_deliver(ec_render_job *job, double start, ec_error *err);

/* Part of that: the film with its report to these files; a slice with its sums. */
ec_result ec_render_job_write(ec_render_job *job, ec_outputs *outputs, ec_render_report *report, ec_error *err);

/* Tells the listener, as the request wants it told. */
ec_result ec_render_job_tell(const ec_render_job *job, const ec_render_report *report, ec_error *err);

/* All of a prepared job: runs and delivers it. Where the device fails, the picture so far is written, and the job fails all the same. */
ec_result ec_render_job_complete(ec_render_job *job, double start, ec_error *err);
/* A report of the job so far; outputs: room for the paths. Texts are the job's. */
ec_render_report ec_render_job_report(ec_render_job *job, const char *outputs[EC_OUTPUTS_MAX]);

void ec_render_job_free(ec_render_job *job); /* half-built ones are fine */

#endif
