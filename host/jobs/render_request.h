/* The request that the options of `eclat render` make. */
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

/* --eye, --look-at, --up, --fov, --parallel: a camera of the command line, or one of the scene's with something changed. */
typedef struct ec_camera_change {
    bool has_eye, has_target, has_up, has_lens; /* lens: fov or tall */
    ec_viewpoint to;                            /* what was given */
} ec_camera_change;

/* auto: where an error is asked for. */
typedef enum ec_adaptive { EC_ADAPTIVE_AUTO, EC_ADAPTIVE_ON, EC_ADAPTIVE_OFF } ec_adaptive;

/* Under the scene: nothing, a matte floor, or what catches its shadows alone (shadow.h). */
typedef enum ec_ground { EC_GROUND_NONE, EC_GROUND_MATTE, EC_GROUND_SHADOW } ec_ground;

typedef struct ec_render_request {
    const char *scene;
    ec_scene_choice choice;
    ec_outputs outputs;
    ec_channel_set channels;   /* of EXRs; 0: the default ones */
    bool default_outputs;      /* no -o was given */
    ec_render_options options; /* complete but for the camera and, without --size, the size */
    bool has_size;
    uint32_t default_height;   /* without --size; 0: that of `eclat render` */
    bool endless;              /* --max-depth inf was given */
    bool capped;               /* neither --spp nor the default: the safety cap applies */
    const char *camera;        /* NULL: the scene's default */
    ec_camera_change look;
    const char *environment;   /* NULL: the scene's own */
    double env_degrees, env_strength; /* 0 and 1: as it is */
    bool adjusts_env;          /* one of these was given */
    const char *device;        /* NULL: chosen */
    const char *light_groups;  /* names; NULL: none */
    ec_exposure exposure;
    ec_background background;
    ec_ground ground;
    unsigned png_depth;        /* of ec_png_depths: 8 or 16 bits */
    ec_frame_range frames;     /* of a sequence; not given: one picture */
    uint32_t orbit;            /* frames in which the camera goes round the scene once; 0: it stays */
    double turn;               /* degrees that it has gone round */
    bool seed_is_frame;        /* --seed frame */
    const char *sheet;         /* small pictures of all of the job in one; NULL: none */
    const char *scenarios, *folder; /* a file of them, and where their pictures go; NULL: none */
    uint32_t shard, shard_count; /* the shard-th picture of each shard_count, from 1; 0: all */
    bool overwrite;            /* frames that are there and of another job */
    bool has_slice;            /* --samples A:B: */
    uint32_t slice_first, slice_end; /* samples a pixel */
    uint32_t slice_cut;        /* samples that its last batch lacks */
    bool slice_of_any;         /* of a job without an end: no --spp */
    ec_adaptive adaptive;
    const char *checkpoint;    /* NULL: none */
    const char *snapshot;      /* a picture on the way; NULL: none */
    double every;              /* seconds between two of these */
    const char *resume;        /* a checkpoint to resume; NULL: none */
    ec_tonemap tonemap;
    ec_ocio_choice ocio;       /* in its place; config NULL: none */
    uint32_t plan_ranks;       /* say what up to so many ranks would buy, and render no picture; 0: render */
    double plan_gbit, plan_microseconds; /* what is assumed for that */
    bool quiet, verbose, json;
} ec_render_request;

/* Its options, for commands that take most of them too: their target begins with an ec_render_request. Defaults before they are read,
 * what follows from them and what does not go together after that. */
extern const ec_option ec_render_rows[];
extern const int ec_render_row_count;
const ec_option *ec_render_row(const char *name); /* NULL: there is none */
ec_result ec_render_refuse_live(void *target, const char *option, const char *value, ec_error *err); /* the setter of rows that are not_in_window */
int ec_render_rows_for(uint32_t use, ec_option *rows); /* copies those with that EC_OPTION_* as borrowed, returns their number */
void ec_render_request_start(void *request);
ec_result ec_render_request_settle(ec_render_request *request, const ec_option *options, int count, const bool *given,
                                   ec_error *err);

/* Does an option of `render` mean anything to that integrator? */
bool ec_combinations_belongs(const char *option, ec_integrator integrator);

/* Checks a grid's density (0: not given) and the acceleration structure asked for, which may be NULL. takes_all: "all" is one. */
ec_result ec_combinations_check_grid(double density, const char *accel, bool takes_all, ec_error *err);

/* Of its EXRs. */
ec_channel_set ec_render_channels(const ec_render_request *request);

/* Does anything end it: samples, time or an error? */
bool ec_render_has_limit(const ec_render_options *options);

/* Why a picture of this request has to be rendered whole, an option; NULL: it may be rendered in strips. */
const char *ec_render_whole_for(const ec_render_request *request);

/* After --resume: the request that began the job, its limits as they were last, and what is given now over it: an output or a limit replaces all
 * that there were. request: of what is given now alone. before: the options that began the job, to which texts of the request point. */
ec_result ec_render_request_resume(const ec_job *job, const ec_given_options *now, ec_render_request *request, ec_given_options *before,
                                   ec_error *err);

#endif
