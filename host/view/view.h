/* A window that shows a render converging. Four threads: the window's, which alone knows GLFW and OpenGL and never waits; the
 * renderer's (renderer.c), which takes batches and previews from a session; the loader's (loader.c), which reads files and sets
 * sessions up; the watcher's (watcher.c), which hears of changed files. They share ec_view, under one lock (shared.h), and sleep
 * where there is nothing to do. */
#ifndef EC_VIEW_VIEW_H
#define EC_VIEW_VIEW_H

#include "cl/cl.h"
#include "film/film.h"
#include "image/image.h"
#include "render/render.h"
#include "scene/scene.h"

/* A picture that is to be saved. Valid during the call. */
typedef struct ec_view_shot {
    const ec_film *film;
    const ec_scene *scene;
    const ec_render_stats *stats;
    const ec_render_options *options; /* with the samples and batches that the film has */
    bool moved;                       /* the camera is `viewpoint`; else options->camera of the scene */
    ec_viewpoint viewpoint;
    double env_degrees, exposure;
    ec_tonemap tonemap;
} ec_view_shot;

typedef struct ec_view_request {
    ec_device_info device;
    ec_render_options options;      /* the size is the window's first; 0x0: the loaded scene's */
    double env_degrees, exposure;
    ec_tonemap tonemap;
    const char *scene, *environment; /* files to watch; environment may be NULL or a colour */
    const char *against;             /* .exr beside the picture, or NULL */
    const char *script;              /* file, "orbit" or NULL */
    bool stats;                      /* first light and frame times to standard output at the end */
    void *user;
    /* From the loader's thread: the scene with its light, unturned; options: camera and size. */
    ec_result (*load)(void *user, ec_scene **scene, ec_render_options *options, ec_error *err);
    /* From the renderer's thread. told: one line for the window. */
    ec_result (*save)(void *user, const ec_view_shot *shot, char *told, size_t size, ec_error *err);
    int stop;                        /* a descriptor, readable once the window is to close (Ctrl-C); -1: none */
} ec_view_request;

/* Until the window is closed. Fails where there is no window to be had, or the first load fails. */
ec_result ec_view_run(const ec_view_request *request, ec_error *err);

/* What the i-th key is called and does; false behind the last. */
bool ec_view_key_at(size_t i, const char **shown, const char **help);

/* Both of the module that has the window, for programs that do without where it is missing. */
typedef struct ec_view_module {
    ec_result (*run)(const ec_view_request *request, ec_error *err);
    bool (*key_at)(size_t i, const char **shown, const char **help);
} ec_view_module;
ec_result ec_view_load(const ec_view_module **module, ec_error *err);

#endif
