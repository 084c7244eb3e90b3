/* The loader's thread: loads the scene, and again when a file changes, and sets up sessions for the requested view. Meanwhile the picture goes on with
 * the previous ones. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "live/shared.h"
#include "live/watch.h"
#include "pack/pack.h"

#define SETTLES 0.3  /* seconds for which files must be unchanged before they are read */
#define DEAF_LOOKS 1 /* seconds between checks of files whose changes are not reported */

/* The view that a session was made for, the picture's or the second one's. */
typedef struct made_for {
    uint32_t serial;   /* of the scene; 0: never */
    eclat_integrator integrator;
    uint64_t without;
} made_for;

typedef struct loader {
    ec_live *live;
    ec_watch watch;
    uint32_t loads, reloads, file_events;
    made_for made[ECLAT_SHOWN_COUNT];
    bool has_failed[ECLAT_SHOWN_COUNT];
} loader;

static void say_loading(ec_live *live, const char *what)
{
    pthread_mutex_lock(&live->lock);
    snprintf(live->status.loading, sizeof live->status.loading, "%s", what);
    ec_live_tell(live);
    pthread_mutex_unlock(&live->lock);
}

static ec_result find_cameras(ec_live_scene *s, ec_error *err)
{
    const ec_scene *scene = s->job.scene;
    _Static_assert(sizeof *s->cameras == sizeof(ec_viewpoint), "alike");
    s->cameras = calloc(scene->camera_count, sizeof *s->cameras);
    if (!s->cameras) return ec_fail(err, "out of memory for %u cameras", scene->camera_count);
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        const ec_camera *camera = &scene->cameras[i];
        double reach = ec_camera_reach(scene, camera);
        ec_viewpoint viewpoint;
        /* The job's camera looks at the surface in the middle of its picture. */
        if (i == s->request.options.camera) reach = fmin(reach, ec_live_pick(scene, camera, &(ec_render_options){.width = 1, .height = 1}, 0, 0).distance);
        ec_camera_viewpoint(camera, scene->center, reach, &viewpoint);
        memcpy(&s->cameras[i], &viewpoint, sizeof viewpoint);
    }
    return EC_OK;
}

static ec_result find_facts(ec_live_scene *s, eclat_facts *f, ec_error *err)
{
    const ec_scene *scene = s->job.scene;
    ec_effects effects;
    EC_TRY(find_cameras(s, err));
    f->width = s->request.options.width;
    f->height = s->request.options.height;
    f->cameras = s->cameras;
    f->camera = s->request.options.camera;
    f->camera_count = scene->camera_count;
    f->effects = s->effects;
    f->has_map = scene->environment.rgb != NULL;
    for (int k = 0; k < 3; k++) {
        double half = 0.5 * ((double)scene->bounds_max[k] - scene->bounds_min[k]);
        f->center[k] = 0.5 * ((double)scene->bounds_max[k] + scene->bounds_min[k]) + scene->center[k];
        f->radius += half * half;
    }
    f->radius = f->radius > 0 ? sqrt(f->radius) : 1;
    if (ec_scene_calls(scene, &effects, NULL) == EC_OK) s->optional = effects.bits & ec_effects_optional;
    for (uint32_t i = 0; i < ec_feature_count; i++)
        if (s->optional & ec_features[i].bit) s->effects[f->effect_count++] = (eclat_effect){ec_features[i].name, ec_features[i].bit};
    return EC_OK;
}

/* Keeps a complete picture rather than replace it by one with white instead of an image. */
static ec_result check_images(const ec_live *live, const ec_scene *scene, ec_error *err)
{
    bool was_whole = live->scene && !live->scene->job.scene->lost_image;
    return was_whole && scene->lost_image ? ec_fail(err, "%s: %.1200s", live->request.scene, scene->lost_image) : EC_OK;
}

static ec_result load(loader *l, ec_error *err)
{
    ec_live *live = l->live;
    ec_watch_stop(&l->watch);
    ec_watch_start(&l->watch, live->request.scene, live->request.environment, live->files); /* a built-in environment is not a file, which does no harm */
    ec_live_scene *s = calloc(1, sizeof *s);
    if (!s) return ec_fail(err, "out of memory for a scene");
    s->users = 1;
    s->request = live->request;
    s->job = (ec_render_job){.request = &s->request, .listener = &live->listener};
    eclat_facts facts = {.serial = ++l->loads, .scene = live->request.scene, .device = live->device.name};
    ec_result result = ec_render_job_load(&s->job, err);
    if (result == EC_OK) result = check_images(live, s->job.scene, err);
    if (result == EC_OK) result = find_facts(s, &facts, err);
    if (result != EC_OK) {
        ec_live_scene_release(live, s);
        return result;
    }
    ec_error lost = {0};
    if (s->job.scene->lost_image) ec_fail(&lost, "%s: %.1200s; it is taken as white", live->request.scene, s->job.scene->lost_image);
    pthread_mutex_lock(&live->lock);
    ec_live_scene *old = live->scene;
    live->facts = facts;
    live->scene = s;
    ec_live_tell(live);
    pthread_mutex_unlock(&live->lock);
    ec_live_scene_release(live, old);
    ec_live_say_trouble(live, ECLAT_TROUBLE_FILES, lost.text, false);
    return EC_OK;
}

static void hand_over(ec_live *live, eclat_shown which, ec_live_setup *setup)
{
    pthread_mutex_lock(&live->lock);
    ec_live_setup *unclaimed = live->incoming[which];
    live->incoming[which] = setup;
    ec_live_wake(live);
    pthread_mutex_unlock(&live->lock);
    ec_live_setup_free(live, unclaimed);
}

/* Returns false if it failed; it is not tried again until something else is requested or, for the first scene, at all. */
static bool set_up(loader *l, eclat_shown which, eclat_integrator integrator, uint64_t without)
{
    ec_live *live = l->live;
    ec_live_setup *setup;
    ec_error err = {0};
    bool is_first = l->made[which].serial == 0 && which == ECLAT_PICTURE;
    l->made[which] = (made_for){live->facts.serial, integrator, without};
    l->has_failed[which] = ec_live_setup_make(live, live->scene, (ec_integrator)integrator, without, &setup, &err) != EC_OK;
    if (l->has_failed[which]) {
        ec_live_say_trouble(live, ECLAT_TROUBLE_SETUP, err.text, is_first);
        return false;
    }
    if (!l->has_failed[!which]) ec_live_say_trouble(live, ECLAT_TROUBLE_SETUP, "", false); /* the other picture's trouble stays */
    hand_over(live, which, setup);
    return true;
}

static bool is_made(const loader *l, eclat_shown which, eclat_integrator integrator, uint64_t without)
{
    const made_for *m = &l->made[which];
    return m->serial == l->live->facts.serial && m->integrator == integrator && m->without == without;
}

/* Waits for the first picture. Kernels that are being compiled would delay those of the rasteriser, which some drivers compile when launched: PoCL
 * has a single lock. */
static void wait_for_light(ec_live *live)
{
    pthread_mutex_lock(&live->lock);
    while (!live->quit && live->status.pictures == 0 && !*live->status.trouble[ECLAT_TROUBLE_CAMERA] && !live->asked.view.is_paused)
        pthread_cond_wait(&live->changed, &live->lock);
    pthread_mutex_unlock(&live->lock);
}

static bool is_picture_made(const loader *l, const eclat_view_request *w) { return is_made(l, ECLAT_PICTURE, w->integrator, w->without); }

static bool is_second_made(const loader *l, const eclat_view_request *w)
{
    return w->second != ECLAT_SECOND_INTEGRATOR || is_made(l, ECLAT_SECOND_PICTURE, w->second_integrator, w->without);
}

/* Sets up the requested view. The first picture comes from the rasteriser, which is the fastest to build and compile. */
static void serve(loader *l, const eclat_view_request *w)
{
    if (!is_picture_made(l, w)) {
        bool is_first = l->made[ECLAT_PICTURE].serial == 0;
        if (is_first && w->integrator != ECLAT_RASTER) {
            if (!set_up(l, ECLAT_PICTURE, ECLAT_RASTER, w->without)) return;
            wait_for_light(l->live);
        }
        say_loading(l->live, "building kernels and structures");
        set_up(l, ECLAT_PICTURE, w->integrator, w->without);
    } else {
        say_loading(l->live, "building the other rung");
        set_up(l, ECLAT_SECOND_PICTURE, w->second_integrator, w->without);
    }
    say_loading(l->live, "");
}

static bool is_served(const loader *l, const eclat_view_request *w) { return is_picture_made(l, w) && is_second_made(l, w); }

/* Waits until there is something to do. Returns true when it is time to check the files. */
static bool wait_for_work(loader *l, bool pending, eclat_view_request *view, bool *quit)
{
    ec_live *live = l->live;
    bool timed = pending || l->watch.is_deaf, late = false;
    struct timespec until = ec_deadline(pending ? SETTLES : DEAF_LOOKS);
    pthread_mutex_lock(&live->lock);
    while (!live->quit && !late && is_served(l, &live->asked.view) && l->reloads == live->asked.view.reloads && l->file_events == live->file_events)
        late = (timed ? pthread_cond_timedwait(&live->changed, &live->lock, &until) : pthread_cond_wait(&live->changed, &live->lock)) != 0;
    *view = live->asked.view;
    *quit = live->quit;
    bool told = l->file_events != live->file_events;
    l->file_events = live->file_events;
    pthread_mutex_unlock(&live->lock);
    return late || told;
}

/* Reloads files that are the same in two consecutive checks; others may still be being written. */
static void reload_if_changed(loader *l, bool *pending)
{
    if (ec_watch_changed(&l->watch)) {
        *pending = true;
        return;
    }
    if (!*pending) return;
    *pending = false;
    ec_error err = {0};
    say_loading(l->live, "loading");
    if (load(l, &err) != EC_OK) ec_live_say_trouble(l->live, ECLAT_TROUBLE_FILES, err.text, false);
    say_loading(l->live, "");
}

void *ec_live_loader(void *argument)
{
    ec_live *live = argument;
    loader l = {.live = live};
    ec_error err = {0};
    bool pending = false;
    say_loading(live, "loading");
    bool loaded = load(&l, &err) == EC_OK;
    if (!loaded) ec_live_say_trouble(live, ECLAT_TROUBLE_FILES, err.text, true);
    for (bool quit = !loaded; !quit;) {
        eclat_view_request view;
        bool look = wait_for_work(&l, pending, &view, &quit);
        if (quit) break;
        if (l.reloads != view.reloads) l.reloads = view.reloads, pending = look = true;
        if (look) reload_if_changed(&l, &pending);
        if (!is_served(&l, &view)) serve(&l, &view);
    }
    ec_watch_stop(&l.watch);
    return NULL;
}
