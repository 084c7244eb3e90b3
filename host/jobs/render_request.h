/* The request that options of `eclat render` fill in. */
#ifndef EC_JOBS_RENDER_REQUEST_H
#define EC_JOBS_RENDER_REQUEST_H

#include <stdbool.h>
#include <stdint.h>

#include "jobs/channel_list.h"
#include "jobs/frames.h"
#include "jobs/given.h"
#include "jobs/outputs.h"
#include "film/exposure.h"
#include "image/image.h"
#include "render/render.h"
#include "scene/scene.h"
#include "store/store.h"

/* --eye, --look-at, --up, --fov, --parallel: changes to a camera of the scene, or a new one. */
typedef struct ec_camera_change {
    bool has_eye, has_target, has_up, has_lens; /* lens: fov or tall is given */
    ec_viewpoint to;                            /* the values given */
} ec_camera_change;

/* auto: on if an error is asked for. */
typedef enum ec_adaptive { EC_ADAPTIVE_AUTO, EC_ADAPTIVE_ON, EC_ADAPTIVE_OFF } ec_adaptive;

/* The ground below the scene: none, a matte floor, or one that shows only the shadows on it (shadow.h). */
typedef enum ec_ground { EC_GROUND_NONE, EC_GROUND_MATTE, EC_GROUND_SHADOW } ec_ground;

typedef struct ec_render_request {
    const char *scene;
    ec_scene_choice choice;
    ec_outputs outputs;
    ec_channel_set channels;   /* of EXRs; 0: the default ones */
    bool default_outputs;      /* no -o was given */
    ec_render_options options; /* complete except for the camera and, without --size, the size */
    bool has_size;
    uint32_t default_height;   /* height without --size; 0: that of `eclat render` */
    bool endless;              /* --max-depth inf was given */
    bool capped;               /* neither --spp nor its default applies: the safety cap does */
    const char *camera;        /* NULL: the scene's default */
    ec_camera_change look;
    const char *environment;   /* NULL: the scene's own */
    double env_degrees, env_strength; /* 0 and 1: unchanged */
    bool adjusts_env;          /* one of these was given */
    const char *device;        /* NULL: chosen automatically */
    const char *light_groups;  /* names; NULL: none */
    ec_exposure exposure;
    ec_background background;
    ec_ground ground;
    unsigned png_depth;        /* index into ec_png_depths: 8 or 16 bits */
    ec_frame_range frames;     /* not given: a single picture */
    uint32_t orbit;            /* frames in which the camera goes once round the scene; 0: it stays */
    double turn;               /* degrees that the camera has gone round */
    bool seed_is_frame;        /* --seed frame */
    const char *sheet;         /* path of a sheet with small versions of all pictures; NULL: none */
    const char *scenarios, *folder; /* path of a scenario file, and the folder for its pictures; NULL: none */
    uint32_t shard, shard_count; /* render the shard-th of every shard_count pictures, from 1; 0: all */
    bool overwrite;            /* replace frames that exist and belong to another job */
    bool has_slice;            /* --samples A:B was given: */
    uint32_t slice_first, slice_end; /* samples per pixel */
    uint32_t slice_cut;        /* samples that its last batch is short of */
    bool slice_of_any;         /* the job has no --spp, and so no end */
    ec_adaptive adaptive;
    const char *checkpoint;    /* NULL: none */
    const char *snapshot;      /* path of a picture written on the way; NULL: none */
    double every;              /* seconds between checkpoints or snapshots */
    const char *resume;        /* a checkpoint to resume; NULL: none */
    ec_tonemap tonemap;
    ec_ocio_choice ocio;       /* replaces tonemap; config NULL: not used */
    uint32_t plan_ranks;       /* plan for up to so many ranks, without rendering a picture; 0: render */
    double plan_gbit, plan_microseconds; /* assumed network: Gbit/s and latency in microseconds */
    bool quiet, verbose, json;
} ec_render_request;

/* The options, also for commands that take most of them: their target must begin with an ec_render_request. _start sets defaults before options are
 * read; _settle completes the request afterwards, and refuses options that do not go together. */
extern const ec_option ec_render_rows[];
extern const int ec_render_row_count;
const ec_option *ec_render_row(const char *name); /* NULL: there is none */
ec_result ec_render_refuse_live(void *target, const char *option, const char *value, ec_error *err); /* setter of rows that are not_in_window */
int ec_render_rows_for(uint32_t use, ec_option *rows); /* copies the rows with this EC_OPTION_* bit, marked as borrowed; returns their number */
void ec_render_request_start(void *request);
ec_result ec_render_request_settle(ec_render_request *request, const ec_option *options, int count, const bool *given,
                                   ec_error *err);

/* Tells whether an option of `render` has a meaning for that integrator. */
bool ec_combinations_belongs(const char *option, ec_integrator integrator);

/* Checks a grid's density (0: not given) against the acceleration structure asked for, which may be NULL. takes_all: "all" is allowed. */
ec_result ec_combinations_check_grid(double density, const char *accel, bool takes_all, ec_error *err);

/* Returns the channels of its EXRs. */
ec_channel_set ec_render_channels(const ec_render_request *request);

/* Tells whether samples, time or an error end the render. */
bool ec_render_has_limit(const ec_render_options *options);

/* Returns the option for which a picture of this request must be rendered whole; NULL: it may be rendered in strips. */
const char *ec_render_whole_for(const ec_render_request *request);

/* Makes the request of --resume: the one that began the job, with its latest limits, overridden by what is given now; an output or limit given now
 * replaces all previous ones. *request: in: the options of now alone. *before: the options that began the job, into which texts of the request point. */
ec_result ec_render_request_resume(const ec_job *job, const ec_given_options *now, ec_render_request *request, ec_given_options *before,
                                   ec_error *err);

#endif
