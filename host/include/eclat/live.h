/* Live sessions: a picture that follows a camera. A part of eclat.h, which includes it.
 * For windows and viewports:
 *
 *     eclat_live_open(job, NULL, &listener, &live, &err);
 *     eclat_wish wish = eclat_live_wished(live);
 *     wish.width = 640, wish.height = 480;
 *     eclat_live_wish(live, &wish);                                      whenever something else is wished
 *     if (eclat_live_take(live, ECLAT_PICTURE, &image)) draw(&image);    whenever listener.wake was called
 *     eclat_live_close(live);
 *
 * A session has threads of its own. They load the scene, and again when one of its files changes; render what is wished, coarse while the camera
 * moves, then finer, then as the job would until its limits are met; and sleep where there is nothing to do. No function but eclat_live_close waits
 * for them. */

#ifndef ECLAT_LIVE_H
#define ECLAT_LIVE_H

#ifndef ECLAT_ECLAT_H
#error "include eclat/eclat.h"
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct eclat_live eclat_live;

/* Both are called from the session's threads, may be NULL, and must not call functions of the session. */
typedef struct eclat_live_listener {
    void *user;
    void (*wake)(void *user);                       /* there is something new: status, facts or a picture */
    void (*saved)(void *user, const char *command); /* the files are written; command: the `eclat render` that makes them again, bit for bit */
} eclat_live_listener;

/* The job's options say what is loaded, on which device, which limits end the picture, and the first wish; "output" names what is saved. They are
 * copied, as both listeners are; messages come from the session's threads. Options of pictures in parts, of sequences and "adaptive" are refused.
 * against: an .exr to stand beside the picture, or NULL. Files that cannot be loaded are told by the status, later. */
eclat_result eclat_live_open(const eclat_job *job, const char *against, const eclat_live_listener *listener, eclat_live **live, eclat_error *err);
void eclat_live_close(eclat_live *live); /* NULL is fine. Waits for what cannot be broken off, such as a compiler */

typedef enum eclat_integrator { ECLAT_PATH, ECLAT_WHITTED, ECLAT_RASTER, ECLAT_LIGHT, ECLAT_INTEGRATOR_COUNT } eclat_integrator;
/* The order of the option tonemap's choices. */
typedef enum eclat_tonemap {
    ECLAT_TONEMAP_NEUTRAL, ECLAT_TONEMAP_NONE, ECLAT_TONEMAP_ACES, ECLAT_TONEMAP_AGX, ECLAT_TONEMAP_FILMIC, ECLAT_TONEMAP_COUNT
} eclat_tonemap;

/* A second picture: maps of the error or of the samples, another integrator's picture, or the file `against`. */
typedef enum eclat_second {
    ECLAT_SECOND_NONE, ECLAT_SECOND_ERROR, ECLAT_SECOND_SAMPLES, ECLAT_SECOND_INTEGRATOR, ECLAT_SECOND_FILE, ECLAT_SECOND_COUNT
} eclat_second;

/* In metres and the file's coordinates. */
typedef struct eclat_viewpoint {
    double eye[3], target[3], up[3]; /* up: a direction */
    double fov;                      /* degrees from the picture's bottom to its top; 0: parallel rays */
    double tall;                     /* of parallel rays: metres from bottom to top */
} eclat_viewpoint;

typedef struct eclat_wish {
    uint32_t width, height;          /* pixels; 0: no picture yet */
    int32_t camera;                  /* one of the facts' cameras; -1: the job's */
    int32_t is_moved;                /* the camera is `viewpoint` instead */
    eclat_viewpoint viewpoint;
    double env_degrees;              /* turns the environment, as the option env-rotate */
    double exposure;                 /* stops, -100 to 100 */
    uint64_t without;                /* bits of effects that are left out; also of such as the scene calls for none of now: another one may */
    eclat_tonemap tonemap;
    eclat_integrator integrator;
    eclat_second second;
    eclat_integrator second_integrator;
    int32_t is_denoised;             /* shows the best of the denoised and the noisy picture, as the option denoise; begins anew when it changes */
    int32_t is_moving;               /* the camera is: speed before detail */
    int32_t is_paused;               /* nobody looks: nothing is rendered */
    uint32_t more;                   /* how often the limits are raised: four times the samples and the time, half the error */
    uint32_t reloads;                /* the scene is loaded again when this changes */
    uint32_t x, y;                   /* a pixel of which the status tells; outside of the picture: none */
} eclat_wish;

/* What was wished last; at first what the job's options say, without a size. */
eclat_wish eclat_live_wished(const eclat_live *live);

/* Replaces it. Makes of *wish what can be had: a moved camera has numbers of nine digits, as commands have them. */
void eclat_live_wish(eclat_live *live, eclat_wish *wish);

typedef struct eclat_effect {
    const char *name;
    uint64_t bit;
} eclat_effect;

typedef struct eclat_facts {
    uint32_t serial;                 /* counts loads; 0: the scene is not there yet, and only the next two lines are known */
    uint32_t width, height;          /* by the option size; else 0 until the scene is there, then 600 high and as wide as the job's camera asks */
    const char *scene, *device;      /* its file; a name */
    uint32_t camera, camera_count;   /* the job's, of so many: */
    const eclat_viewpoint *cameras;
    uint32_t effect_count;
    const eclat_effect *effects;     /* that the scene calls for, and that can be left out */
    double center[3], radius;        /* a sphere around the scene */
    int has_map;                     /* an environment that can be turned */
} eclat_facts;

/* Facts of the scene as it was loaded last; all they point to lasts until this is called again. */
const eclat_facts *eclat_live_facts(eclat_live *live);

/* What a pixel shows. */
typedef struct eclat_probe {
    uint32_t x, y;
    int is_inside;                   /* of the picture; else nothing below is known */
    int has_value, has_error;        /* radiance, and its standard error: */
    double rgb[3], se[3];
    int has_surface;                 /* seen by the pixel's centre: */
    double depth;                    /* metres from the camera */
    int64_t material, node;          /* numbers in the file; -1: none */
    char material_name[100], node_name[100];
    double center[3], radius;        /* a sphere around the node's triangles; 0: it has none */
} eclat_probe;

/* Which of these fails now: the last load of the files, the last set-up of a device, the current camera. */
typedef enum eclat_trouble { ECLAT_TROUBLE_FILES, ECLAT_TROUBLE_SETUP, ECLAT_TROUBLE_CAMERA, ECLAT_TROUBLE_COUNT } eclat_trouble;

typedef struct eclat_status {
    uint64_t pictures;               /* made so far */
    double first_light;              /* seconds from eclat_live_open to the first of them */
    uint32_t preview;                /* pixels of a side that a sample stands for; 0: the picture has all samples so far */
    eclat_integrator integrator;     /* of the picture */
    eclat_second second;             /* what stands beside it; ECLAT_SECOND_NONE: nothing yet */
    eclat_integrator second_integrator;
    uint64_t samples;                /* a pixel */
    double seconds;                  /* of rendering */
    double error, error_bound;       /* as eclat_picture_error has them */
    int is_denoised;                 /* the picture is the best of both, of as many samples as there were when it was made last: */
    eclat_stated_error best;
    char undenoised[320];            /* why it is not, though it was wished; empty: it is, or will be */
    double spp_limit, time_limit, error_limit; /* as raised so far; 0: none */
    double seconds_left;             /* to the first limit; < 0: nothing is known yet */
    int is_settled;                  /* nothing is left to do for what was wished last */
    int is_complete;                 /* a limit is met: */
    char stopped_by[16];             /* "spp", "time" or "error" */
    uint32_t saves;                  /* that are done, or were given up */
    int is_unsaved;                  /* the last one: */
    char told[2304];                 /* where that one went, or why not */
    int has_failed;                  /* 1 + the trouble by which there will never be a picture; 0: none */
    char trouble[ECLAT_TROUBLE_COUNT][2304]; /* empty: it goes well */
    char loading[64];                /* what is being loaded or built; empty: nothing */
    char effects[1024];              /* names of those that are simulated */
    eclat_probe under;               /* the wish's pixel */
    uint32_t picks;                  /* that are answered, the last one by: */
    eclat_probe picked;
} eclat_status;
void eclat_live_status(eclat_live *live, eclat_status *status);

/* Tone-mapped, 3 bytes a pixel, row by row from the top; smaller than was wished while it is a preview. */
typedef struct eclat_image {
    uint32_t width, height;
    const uint8_t *rgb;
} eclat_image;

typedef enum eclat_shown { ECLAT_PICTURE, ECLAT_SECOND_PICTURE, ECLAT_SHOWN_COUNT } eclat_shown;

/* The latest, which stays as it is until the next is taken. 0, and *image is as it was: there is none that was not taken before. */
int eclat_live_take(eclat_live *live, eclat_shown which, eclat_image *image);

/* Asks once what lies under a pixel, in the picture as it is then. Returns the status' number of picks with the answer. */
uint32_t eclat_live_pick(eclat_live *live, uint32_t x, uint32_t y);

/* Replaces the wish, and saves its picture with the samples that it has, or will have first, whatever is wished since; given up where the camera
 * moves before that. To the files of "output", else to the scene's name with .exr and .png; later pictures are NAME-2 and so on. Returns the status'
 * number of saves with it. */
uint32_t eclat_live_save(eclat_live *live, eclat_wish *wish);

#ifdef __cplusplus
}
#endif
#endif
