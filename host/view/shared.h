/* What the threads of the preview share. Internal to view/. */
#ifndef EC_VIEW_SHARED_H
#define EC_VIEW_SHARED_H

#include <pthread.h>

#include "render/session.h"
#include "view/view.h"

typedef enum ec_view_second { EC_SECOND_ERROR, EC_SECOND_SAMPLES, EC_SECOND_RUNG, EC_SECOND_FILE, EC_SECOND_COUNT } ec_view_second;
typedef enum ec_view_layout { EC_LAYOUT_ONE, EC_LAYOUT_WIPE, EC_LAYOUT_BESIDE, EC_LAYOUT_COUNT } ec_view_layout;

typedef enum ec_view_lines { EC_LINES_ALL, EC_LINES_ONE, EC_LINES_NONE, EC_LINES_COUNT } ec_view_lines;

/* What the user wants: written by the window, read by the others. */
typedef struct ec_view_wish {
    uint32_t serial;              /* counts changes */
    bool moved;                   /* the camera is `viewpoint`; else the scene's number `camera` */
    ec_viewpoint viewpoint;       /* of numbers of nine digits */
    uint32_t camera;
    uint32_t width, height;       /* of the picture; 0: no window yet */
    double env_degrees;
    ec_integrator integrator, rung; /* rung: of the second picture */
    uint64_t without;             /* also what the scene calls for none of now: another one may */
    double exposure;
    ec_tonemap tonemap;
    ec_view_second second;
    bool has_second;              /* it is shown */
    bool moving;                  /* the camera is: speed before detail */
    bool paused;                  /* nothing to be seen */
    uint32_t more;                /* times the limits were raised */
    uint32_t saves, reloads;      /* asked for so far */
    uint32_t probes;              /* changes of the place: */
    uint32_t probe_x, probe_y;    /* pixel of the picture; UINT32_MAX: none */
    uint32_t clicks, click_x, click_y; /* the same, of what was clicked at */
} ec_view_wish;

typedef struct ec_view_probe {
    uint32_t serial;              /* of wish.probes, or wish.clicks */
    bool is_inside, has_film, has_error, has_surface;
    uint32_t x, y;
    double rgb[3], se[3], depth;
    int64_t material, node;       /* -1: none, or not known */
    char name[100], node_name[100];
    double center[3], radius;     /* around that node's triangles, in the file's coordinates; 0: there are none */
} ec_view_probe;

/* Who has failed, as long as he has: the last load of the files, the last set-up, the camera that is looked through. */
typedef enum ec_view_trouble { EC_TROUBLE_FILES, EC_TROUBLE_SETUP, EC_TROUBLE_CAMERA, EC_TROUBLE_COUNT } ec_view_trouble;

/* What there is to tell: written by renderer and loader, read by the window. */
typedef struct ec_view_status {
    double first_light;           /* seconds from ec_view_run; 0: not yet */
    uint64_t pictures;            /* shown so far */
    uint32_t preview;             /* pixels of a side that one sample stands for; 0: the film itself is shown */
    ec_integrator integrator;     /* of what is shown */
    ec_view_second second;        /* what is beside it, of the same camera; EC_SECOND_COUNT: nothing yet */
    ec_integrator rung;           /* if it is one */
    uint64_t samples;             /* a pixel, of the film */
    double seconds, error, error_bound;
    double spp_limit, time_limit, error_limit; /* as raised so far; 0: none */
    ec_forecast forecast;
    bool done;                    /* a limit is reached */
    uint32_t settled;             /* serial of the last wish with which nothing was left to do */
    char stopped_by[16];
    uint32_t saves_done;
    char told[2300];              /* of the last save, or failure */
    char unsaved[256];            /* why the last save was given up; empty: it was not */
    char trouble[EC_TROUBLE_COUNT][2300]; /* empty: it went well */
    char loading[64];             /* what the loader is at; empty: nothing */
    char effects[1024];           /* active ones, by name */
    ec_view_probe probe, clicked;
} ec_view_status;

/* Facts of the scene, for the window. */
typedef struct ec_view_facts {
    uint32_t serial;              /* 0: not loaded yet */
    uint32_t camera, camera_count, width, height; /* by default */
    const ec_viewpoint *cameras;  /* of `scene`, which whoever keeps the facts is a user of */
    struct ec_view_scene *scene;
    double center[3], radius;
    bool has_map;                 /* an environment that can be turned */
    uint64_t optional;            /* the scene's */
} ec_view_facts;

/* A loaded scene, shared by sessions. */
typedef struct ec_view_scene {
    ec_scene *scene;
    ec_viewpoint *cameras;        /* owned, one for each of the scene's */
    uint32_t users, serial;
    uint64_t optional;            /* effects that it calls for and that can be left out */
    ec_render_options options;    /* camera and size by default */
} ec_view_scene;

/* Scene, kernels and buffers, ready to be looked at. */
typedef struct ec_view_setup {
    ec_cl cl;
    ec_view_scene *scene;
    ec_session *session;
    uint64_t without;             /* as wished; options have what the scene calls for, and may leave out more */
    ec_render_options options;
    ec_render_stats stats;
} ec_view_setup;
enum { EC_ROLE_PICTURE, EC_ROLE_SECOND, EC_ROLE_COUNT };

/* A picture on its way to the graphics card: mapped memory of a pixel buffer, so that tone mapping writes where the upload reads. */
enum { EC_VIEW_SLOTS = 4 };
typedef struct ec_view_slot {
    enum { EC_UPLOAD_AWAY, EC_UPLOAD_FREE, EC_UPLOAD_WRITING, EC_UPLOAD_READY } state;
    uint8_t *bytes;
    size_t capacity;
    uint32_t width, height, role;
    uint64_t serial;
} ec_view_slot;

enum { EC_VIEW_THREADS = 3 };
typedef struct ec_view {
    const ec_view_request *request;
    double start;
    pthread_t window, thread[EC_VIEW_THREADS];
    uint32_t threads;             /* that are running */
    bool has_window;              /* GLFW can be told of changes */
    int files, leave;             /* descriptors: of inotify; readable once the watcher is to end. -1: none */
    pthread_mutex_t lock;         /* guards all below */
    pthread_cond_t changed;
    uint64_t events;              /* counts changes, so that none is slept through */
    bool quit, stopped;           /* stopped: from outside */
    uint32_t file_events;         /* something happened beside the scene's files */
    ec_error fatal;
    bool failed;
    ec_view_wish wish, asked;     /* asked: as it was at the last S */
    ec_view_status status;
    ec_view_facts facts;
    ec_view_setup *incoming[EC_ROLE_COUNT]; /* from loader to renderer */
    uint64_t picture_serial;
    ec_view_slot slots[EC_VIEW_SLOTS];
} ec_view;

/* Tells the other threads, and the window. With the lock held. */
void ec_view_post(ec_view *view);

/* NULL: it goes well (again). */
void ec_view_say_trouble(ec_view *view, ec_view_trouble whose, const ec_error *err);

/* setup.c: scenes are shared under the view's lock; setups belong to one thread at a time */
void ec_view_scene_release(ec_view *view, ec_view_scene *scene);
ec_result ec_view_setup_make(ec_view *view, ec_view_scene *scene, ec_integrator integrator, uint64_t without, ec_view_setup **setup,
                             ec_error *err);
void ec_view_setup_free(ec_view *view, ec_view_setup *setup); /* NULL is fine */

void *ec_view_loader(void *view);   /* loader.c */
void *ec_view_renderer(void *view); /* renderer.c */
void *ec_view_watcher(void *view);  /* watcher.c */

/* show.c: a picture of 3 floats a pixel through the CLI's tone mapper to the window; false: no slot was free, ask again later */
bool ec_view_show(ec_view *view, const ec_view_wish *wish, uint32_t role, const float *rgb, uint32_t width, uint32_t height);
/* Shows bytes that are there already: `fill` writes them where they are wanted. */
typedef void (*ec_view_fill)(const void *user, uint8_t *bytes);
bool ec_view_show_filled(ec_view *view, uint32_t role, uint32_t width, uint32_t height, ec_view_fill fill, const void *user);

/* pick.c: the surface that a pixel's centre sees, by trying all triangles */
typedef struct ec_view_hit {
    double distance;  /* metres from the camera; infinite: none */
    uint32_t triangle, id; /* place in the scene's arrays; id: another where its mesh is kept once */
} ec_view_hit;
ec_view_hit ec_view_pick(const ec_scene *scene, const ec_camera *camera, uint32_t width, uint32_t height, uint32_t x, uint32_t y);
void ec_view_node_sphere(const ec_scene *scene, uint32_t node, double center[3], double *radius);

#endif
