/* Live sessions: a picture that follows a camera, for windows and viewports. A part of eclat.h, which includes it.
 *
 *     eclat_live_open(job, NULL, &listener, &live, &err);
 *     eclat_view_request view = eclat_live_view(live);
 *     view.width = 640, view.height = 480;
 *     eclat_live_set_view(live, &view);                                  whenever the view changes
 *     if (eclat_live_take(live, ECLAT_PICTURE, &image)) draw(&image);    whenever listener.wake was called
 *     eclat_live_close(live);
 *
 * A session has threads of its own. They load the scene, and load it again when one of its files changes. They render the requested view: coarsely while
 * the camera moves, then finer, then like the job until one of its limits is met. They sleep when there is nothing to do. No function but
 * eclat_live_close waits for them. A session may be used by one thread at a time. */

#ifndef ECLAT_LIVE_H
#define ECLAT_LIVE_H

#ifndef ECLAT_ECLAT_H
#error "include eclat/eclat.h"
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct eclat_live eclat_live;

/* Callbacks, made from the session's threads. Each may be NULL, and must not call functions of the session. */
typedef struct eclat_live_listener {
    void *user;
    void (*wake)(void *user);                       /* there is something new: status, facts or a picture */
    void (*saved)(void *user, const char *command); /* files were written; command: the `eclat render` that writes them again, bit for bit */
} eclat_live_listener;

/* Opens a session for a job of "render" with one scene. The job's options say what is loaded, on which device, which limits end the picture, and what
 * the first view is; "output" names the files of eclat_live_save. Options and both listeners are copied; the job's listener gets messages from the
 * session's threads. Options of sequences and of pictures in parts, and "adaptive", are refused. against: an .exr to show beside the picture, or
 * NULL. Scene files that cannot be loaded are reported later, in the status. */
eclat_result eclat_live_open(const eclat_job *job, const char *against, const eclat_live_listener *listener, eclat_live **live, eclat_error *err);
void eclat_live_close(eclat_live *live); /* NULL is fine. Waits for what cannot be interrupted, such as a compiler */

typedef enum eclat_integrator { ECLAT_PATH, ECLAT_WHITTED, ECLAT_RASTER, ECLAT_LIGHT, ECLAT_INTEGRATOR_COUNT } eclat_integrator;
/* In the order of the choices of the option "tonemap". */
typedef enum eclat_tonemap {
    ECLAT_TONEMAP_NEUTRAL, ECLAT_TONEMAP_NONE, ECLAT_TONEMAP_ACES, ECLAT_TONEMAP_AGX, ECLAT_TONEMAP_FILMIC, ECLAT_TONEMAP_COUNT
} eclat_tonemap;

/* A second picture: a map of the error or of the samples, another integrator's picture, or the file `against`. */
typedef enum eclat_second {
    ECLAT_SECOND_NONE, ECLAT_SECOND_ERROR, ECLAT_SECOND_SAMPLES, ECLAT_SECOND_INTEGRATOR, ECLAT_SECOND_FILE, ECLAT_SECOND_COUNT
} eclat_second;

/* In metres, in the coordinates of the file. */
typedef struct eclat_viewpoint {
    double eye[3], target[3], up[3]; /* up: a direction of any length */
    double fov;                      /* vertical field of view in degrees; 0: parallel rays */
    double tall;                     /* for parallel rays: height of the picture in metres */
} eclat_viewpoint;

typedef struct eclat_view_request {
    uint32_t width, height;          /* pixels; 0: no picture yet */
    int32_t camera;                  /* index into the facts' cameras; -1: the job's */
    int32_t is_moved;                /* 1: the camera is `viewpoint` instead */
    eclat_viewpoint viewpoint;
    double env_degrees;              /* turns the environment, like the option "env-rotate" */
    double exposure;                 /* stops, -100 to 100 */
    uint64_t without;                /* bits of effects to leave out; may include effects that this scene does not call for, as a reloaded one may */
    eclat_tonemap tonemap;
    eclat_integrator integrator;
    eclat_second second;
    eclat_integrator second_integrator;
    int32_t is_denoised;             /* 1: shows the best blend of denoised and noisy picture, like the option "denoise"; a change begins the picture anew */
    int32_t is_moving;               /* 1: the camera is moving, and speed matters more than detail */
    int32_t is_paused;               /* 1: nobody is looking, and nothing is rendered */
    uint32_t more;                   /* how often the limits are raised: each time to four times the samples and the time, and half the error */
    uint32_t reloads;                /* any change of this number loads the scene again */
    uint32_t x, y;                   /* the pixel that the status' `under` describes; outside of the picture: none */
} eclat_view_request;

/* Returns the requested view; at first, that of the job's options, without a size. */
eclat_view_request eclat_live_view(const eclat_live *live);

/* Requests another view, and changes *view to what is possible: values are limited, and a moved camera is rounded to nine digits, as in commands. */
void eclat_live_set_view(eclat_live *live, eclat_view_request *view);

typedef struct eclat_effect {
    const char *name;
    uint64_t bit;
} eclat_effect;

typedef struct eclat_facts {
    uint32_t serial;                 /* counts loads; 0: the scene is not loaded yet, and only the next two lines are known */
    uint32_t width, height;          /* by the option "size"; else 0 until the scene is loaded, then 600 high and as wide as the job's camera asks */
    const char *scene, *device;      /* path of the scene; name of the device */
    uint32_t camera, camera_count;   /* the job's camera, and the length of `cameras` */
    const eclat_viewpoint *cameras;
    uint32_t effect_count;
    const eclat_effect *effects;     /* those that the scene calls for and that can be left out */
    double center[3], radius;        /* a sphere around the scene */
    int has_map;                     /* 1: there is an environment that can be turned */
} eclat_facts;

/* Returns facts of the scene as it was last loaded. They and all they point to are valid until the next call. */
const eclat_facts *eclat_live_facts(eclat_live *live);

/* The surface that a pixel shows, and its light. */
typedef struct eclat_probe {
    uint32_t x, y;
    int is_inside;                   /* the pixel is in the picture; otherwise nothing below is known */
    int has_value, has_error;        /* radiance, in rgb, and its standard error, in se, are known */
    double rgb[3], se[3];
    int has_surface;                 /* the pixel's centre sees a surface, which the fields below describe */
    double depth;                    /* metres from the camera */
    int64_t material, node;          /* indices in the file; -1: none */
    char material_name[100], node_name[100];
    double center[3], radius;        /* a sphere around the node's triangles; radius 0: it has none */
} eclat_probe;

/* The parts of a session that may be failing now: the last load of the files, the last set-up of a device, the current camera. */
typedef enum eclat_trouble { ECLAT_TROUBLE_FILES, ECLAT_TROUBLE_SETUP, ECLAT_TROUBLE_CAMERA, ECLAT_TROUBLE_COUNT } eclat_trouble;

typedef struct eclat_status {
    uint64_t pictures;               /* made so far */
    double first_light;              /* seconds from eclat_live_open to the first picture */
    uint32_t preview;                /* side in pixels of the square that one sample stands for; 0: the picture has all samples so far */
    eclat_integrator integrator;     /* of the picture */
    eclat_second second;             /* the second picture that is shown; ECLAT_SECOND_NONE: none yet */
    eclat_integrator second_integrator;
    uint64_t samples;                /* per pixel */
    double seconds;                  /* spent rendering */
    double error, error_bound;       /* as in eclat_picture_error */
    int is_denoised;                 /* 1: the picture is the best blend, made of the samples there were then; `best` is its error */
    eclat_stated_error best;
    char undenoised[320];            /* why it is not, although requested; empty: it is, or will be */
    double spp_limit, time_limit, error_limit; /* as raised so far; 0: none */
    double seconds_left;             /* until the first limit is met; < 0: unknown yet */
    int is_settled;                  /* 1: nothing is left to do for the requested view */
    int is_complete;                 /* 1: a limit is met, which stopped_by names */
    char stopped_by[16];             /* "spp", "time" or "error" */
    uint32_t saves;                  /* done or given up so far */
    int is_unsaved;                  /* 1: the last one failed or was given up */
    char told[2304];                 /* where the last one went, or why it failed */
    int has_failed;                  /* 0, or 1 + the eclat_trouble because of which there will never be a picture */
    char trouble[ECLAT_TROUBLE_COUNT][2304]; /* by eclat_trouble; empty: none */
    char loading[64];                /* what is being loaded or built; empty: nothing */
    char effects[1024];              /* names of those that are simulated */
    eclat_probe under;               /* the pixel x, y of the view */
    uint32_t picks;                  /* answered so far; `picked` answers the last one */
    eclat_probe picked;
} eclat_status;
void eclat_live_status(eclat_live *live, eclat_status *status);

/* A tone-mapped picture, 3 bytes per pixel, row by row from the top; smaller than requested while it is a preview. */
typedef struct eclat_image {
    uint32_t width, height;
    const uint8_t *rgb;
} eclat_image;

typedef enum eclat_shown { ECLAT_PICTURE, ECLAT_SECOND_PICTURE, ECLAT_SHOWN_COUNT } eclat_shown;

/* Takes the latest picture, if it was not taken before: returns 1 and sets *image, whose pixels stay valid until the next one is taken. Otherwise
 * returns 0 and leaves *image as it was. */
int eclat_live_take(eclat_live *live, eclat_shown which, eclat_image *image);

/* Asks once what the picture shows at a pixel. Returns the value that the status' `picks` has once `picked` answers this call. */
uint32_t eclat_live_pick(eclat_live *live, uint32_t x, uint32_t y);

/* Requests a view, and saves its picture with the samples that it has, or with the first ones that it gets, whatever is requested meanwhile; gives up
 * if the camera moves before that. Writes the files of "output" or, without it, the scene's name with .exr and .png; later pictures are NAME-2 and so
 * on. Returns the value that the status' `saves` has once this one is done or given up. */
uint32_t eclat_live_save(eclat_live *live, eclat_view_request *view);

#ifdef __cplusplus
}
#endif
#endif
