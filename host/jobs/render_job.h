/* A render from request to film. */
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
    const char *program;         /* as it was called, for commands of checkpoints; NULL: none */
    const char *command;         /* the job's command line */
    ec_scene *scene;             /* owned */
    ec_light_groups groups;      /* of the scene. Owned */
    ec_matte_names mattes;       /* likewise */
    ec_ranks *ranks;             /* the other processes of an MPI job; NULL: none */
    ec_peers peers;            /* the other processes, as the render sees them */
    ec_frame_share *share;       /* NULL: this is the only picture of its job */
    ec_frame_facts frame;        /* used with share */
    bool takes_several;          /* may use several devices; otherwise a list of them is refused */
    bool is_blank;               /* the camera sees no surface */
    bool in_memory;              /* the whole film is wanted in memory, not in files */
    bool renders;                /* renders once the scene is loaded: the device is opened meanwhile */
    ec_device_info devices[EC_DEVICES_MOST];
    uint32_t device_indices[EC_DEVICES_MOST], device_count;
    const char *device_why;
    ec_cl early;                 /* the device opened while the scene is loaded; without a context if it was not. Owned */
    ec_last_build last_build;    /* kernels built on it meanwhile */
    ec_denoised denoised;        /* of the film, with options.denoise */
    ec_behind behind;            /* with a blurred background. Owned */
    ec_film film;                /* empty if the picture was rendered in strips, which `rows` writes to the files */
    ec_row_writer *rows;         /* owned; NULL: no strip is complete, or the picture was rendered whole */
    ec_ocio *ocio;               /* with --ocio. Owned */
    double shadow_error;         /* error of the alpha of a ground that catches shadows (shadow.h); NaN: unknown */
    ec_render_stats stats;
    ec_render_options rendered;  /* as reports state them; set by ec_render_job_report */
    double load_seconds;         /* until devices and scene were ready */
    char camera_text[256];
    ec_viewpoint viewpoint;
    char environment_text[256];
    char image_sha256[EC_HASH_SIZE];
    ec_job job;                  /* what checkpoints and slices store; its texts belong to the caller */
    ec_stored stored;            /* the checkpoint that is resumed. Owned */
    ec_given_options before;     /* options that began the resumed job */
    char device_text[1024];      /* the devices' drivers: cl/workarounds.h */
    char *whole_command;         /* the command that would render a resumed job without a break. Owned */
    uint32_t shot_batches;       /* batches in the last snapshot */
    bool has_kept;               /* a checkpoint was written */
    ec_error keep_error;         /* why the last checkpoint failed; empty: it did not, or none was wanted */
} ec_render_job;

/* Prepares outputs, device, scene, environment and camera: everything that can fail early. */
ec_result ec_render_job_prepare(ec_render_job *job, ec_error *err);

/* Checks that outputs and checkpoint may be written, and that none is an input. Part of ec_render_job_prepare. */
ec_result ec_render_check_files(const ec_render_request *request, ec_error *err);

/* Finds the device of the request, or all that it names if takes_several. */
ec_result ec_render_job_find_devices(ec_render_job *job, ec_error *err);

/* Prepares device, scene, environment, camera and size: all but the outputs. */
ec_result ec_render_job_load(ec_render_job *job, ec_error *err);

/* Sets the environment that the request asks for, or the studio if job->scene has no light. Part of ec_render_job_load. */
ec_result ec_render_job_light(ec_render_job *job, ec_error *err);

/* To be called first of all with --resume: reads the checkpoint and completes the request by it. */
ec_result ec_render_job_take_up(ec_render_job *job, const ec_given_options *now, ec_error *err);

/* Returns which batches are taken, what they continue, and what is kept on the way. Takes over the film of a checkpoint. */
ec_course ec_render_job_course(ec_render_job *job);

/* Renders into job->film; the listener may end it early and successfully. On failure the film may have batches too. */
ec_result ec_render_job_run(ec_render_job *job, ec_error *err);

/* Denoises the film if options.denoise is set, unless the last look at its error has. A failure leaves the film unchanged. */
ec_result ec_render_job_denoise(ec_render_job *job, ec_error *err);

/* render_deliver.c: writes the film to the outputs and reports it. start: when the job or frame began. */
ec_result ec_render_job_deliver(ec_render_job *job, double start, ec_error *err);

/* Writes the film with its report to these files; a slice with its sums. Part of ec_render_job_deliver. */
ec_result ec_render_job_write(ec_render_job *job, ec_outputs *outputs, ec_render_report *report, ec_error *err);

/* Reports to the listener, in the form that the request asks for. */
ec_result ec_render_job_tell(const ec_render_job *job, const ec_render_report *report, ec_error *err);

/* Runs and delivers a prepared job. If the device fails, the picture so far is written, and the job still fails. */
ec_result ec_render_job_complete(ec_render_job *job, double start, ec_error *err);
/* Returns a report of the job so far. outputs: room for the paths. Texts belong to the job. */
ec_render_report ec_render_job_report(ec_render_job *job, const char *outputs[EC_OUTPUTS_MAX]);

void ec_render_job_free(ec_render_job *job); /* may be half-built */

#endif
