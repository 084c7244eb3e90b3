/* A live session as described in eclat.h. It has three threads: the renderer's (renderer.c), which takes batches and previews from a session of
 * render/; the loader's (loader.c), which reads files and sets these sessions up; and the watcher's (watcher.c), which hears of changed files. They
 * share ec_live with the caller, under one lock, and sleep when there is nothing to do. View requests go in; facts, status and pictures come out. */
#ifndef EC_LIVE_SHARED_H
#define EC_LIVE_SHARED_H

#include <pthread.h>
#include <string.h>

#include "eclat/eclat.h"
#include "jobs/frame_job.h"
#include "jobs/render_job.h"
#include "render/session.h"

#define EC_LIVE_SLICE 0.02 /* seconds of a wave: the longest delay of a new view */

/* The requests of the caller. */
typedef struct ec_live_asked {
    eclat_view_request view, saved; /* saved: that of the last save */
    uint32_t serial;              /* counts requested views */
    uint32_t saves, picks, pick_x, pick_y;
} ec_live_asked;

/* A loaded scene, shared by setups and the caller. */
typedef struct ec_live_scene {
    ec_render_request request;    /* with its default camera and size */
    ec_render_job job;            /* what was loaded for it */
    eclat_viewpoint *cameras;     /* owned, by camera of the scene */
    eclat_effect effects[EC_EFFECT_BITS]; /* those that it calls for and that can be left out */
    uint64_t optional;            /* the same as bits */
    uint32_t users;
} ec_live_scene;

/* Scene, kernels and buffers, ready to render. */
typedef struct ec_live_setup {
    ec_cl cl;
    ec_live_scene *scene;
    ec_session *session;
    uint64_t without;             /* as requested; options leave out what the scene does not call for, and perhaps more */
    ec_render_options options;
    ec_render_stats stats;
} ec_live_setup;

/* The renderer writes one image while the caller shows another. */
typedef struct ec_live_image {
    uint32_t width, height;
    uint8_t *rgb;                 /* owned */
    uint64_t room;                /* bytes */
} ec_live_image;
typedef struct ec_live_shown {
    ec_live_image written, ready, taken;
    bool is_new;                  /* `ready` was not taken yet */
} ec_live_shown;

enum { EC_LIVE_THREADS = 3 };
typedef struct ec_live {
    ec_render_request request;    /* settled, but with an unturned environment, which views turn */
    ec_given_options given;       /* as given by the caller; for commands */
    ec_listener listener;
    eclat_live_listener hears;
    ec_device_info device;
    uint32_t device_index;
    const char *device_why;
    float *against;               /* the file to show beside the picture, 3 floats per pixel; NULL: none. Owned */
    uint32_t against_width, against_height;
    double start;
    pthread_t thread[EC_LIVE_THREADS];
    uint32_t threads;             /* number running */
    int files, leave;             /* descriptors, -1: none. files: of inotify; leave: readable when the watcher has to end */
    pthread_mutex_t lock;         /* guards everything below */
    pthread_cond_t changed;
    uint64_t events;              /* counts changes, so that none is missed while waiting */
    bool quit;
    uint32_t file_events;         /* counts events near the scene's files */
    ec_live_asked asked;
    uint32_t settled;             /* serial of the last view that was completely rendered */
    eclat_status status;          /* all but is_settled */
    eclat_facts facts;
    ec_live_scene *scene;         /* the scene of the facts, of which the session is a user */
    ec_live_setup *incoming[ECLAT_SHOWN_COUNT]; /* handed from loader to renderer */
    ec_live_shown shown[ECLAT_SHOWN_COUNT];
} ec_live;

/* live.c: opens a session. The caller fills in request, given, listener and hears; everything else must be 0. A session that fails to open is closed. */
ec_result ec_live_open(ec_live *live, const char *against, ec_error *err);
void ec_live_close(ec_live *live);

/* tell.c: wake wakes the session's threads, tell the caller; both with the lock held. */
void ec_live_wake(ec_live *live);
void ec_live_tell(ec_live *live);
/* To be called without the lock. text "": the trouble is over; is_final: there will never be a picture. */
void ec_live_say_trouble(ec_live *live, eclat_trouble whose, const char *text, bool is_final);

/* setup.c: scenes are shared under the lock; a setup belongs to one thread at a time. NULL is fine. */
void ec_live_scene_release(ec_live *live, ec_live_scene *scene);
ec_result ec_live_setup_make(ec_live *live, ec_live_scene *scene, ec_integrator integrator, uint64_t without, ec_live_setup **setup, ec_error *err);
void ec_live_setup_free(ec_live *live, ec_live_setup *setup);

/* loader.c, renderer.c, watcher.c: the threads. */
void *ec_live_loader(void *live);
void *ec_live_renderer(void *live);
void *ec_live_watcher(void *live);

/* canvas: returns memory for the next picture, 3 bytes per pixel; hand_out: passes it to the caller. show: does both, with 3 floats per pixel through
 * the tone mapper. */
ec_result ec_live_canvas(ec_live *live, eclat_shown which, uint32_t width, uint32_t height, uint8_t **rgb, ec_error *err);
void ec_live_hand_out(ec_live *live, eclat_shown which);
ec_result ec_live_show(ec_live *live, const eclat_view_request *view, eclat_shown which, const float *rgb, uint32_t width, uint32_t height, ec_error *err);

/* pick.c: finds the surface that a pixel's centre sees, by testing all triangles. */
typedef struct ec_live_hit {
    double distance;              /* metres from the camera; INFINITY: none */
    uint32_t triangle, id;        /* triangle: index in the scene's arrays; id: differs from it if the mesh is kept once */
} ec_live_hit;
ec_live_hit ec_live_pick(const ec_scene *scene, const ec_camera *camera, const ec_render_options *options, uint32_t x, uint32_t y);
void ec_live_node_sphere(const ec_scene *scene, uint32_t node, double center[3], double *radius);

/* view_request.c: changes a view to what is possible; tells whether two views have the same picture, except for its colours. */
void ec_live_limit_view(eclat_view_request *view);
bool ec_live_same_camera(const eclat_view_request *a, const eclat_view_request *b);

/* repeat_command.c: malloc'ed, NULL when out of memory. options: include the picture's size, camera and samples. */
char *ec_live_command(const ec_live *live, const ec_live_scene *scene, const eclat_view_request *view, const ec_render_options *options,
                      const ec_outputs *outputs);

static inline ec_viewpoint ec_live_viewpoint(const eclat_view_request *view)
{
    ec_viewpoint viewpoint;
    memcpy(&viewpoint, &view->viewpoint, sizeof viewpoint);
    return viewpoint;
}

/* Returns the index of the scene's camera from which the view starts. */
static inline uint32_t ec_live_camera(const ec_live_scene *scene, const eclat_view_request *view)
{
    return view->camera >= 0 && (uint32_t)view->camera < scene->job.scene->camera_count ? (uint32_t)view->camera : scene->request.options.camera;
}

#endif
