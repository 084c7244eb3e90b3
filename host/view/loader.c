/* The loader's thread: reads the scene, and again when a file changes; sets sessions up for what is wished. The picture goes on in
 * the meantime with what there is. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "pack/pack.h"
#include "view/orbit.h"
#include "view/shared.h"
#include "view/watch.h"

#define SETTLES 0.3  /* seconds that files must stay as they are before they are read */
#define DEAF_LOOKS 1 /* seconds between looks where nobody tells of changes */

/* What a role's session was made for. */
typedef struct made_for {
    uint32_t serial;   /* of the scene; 0: never */
    ec_integrator integrator;
    uint64_t without;
} made_for;

typedef struct loader {
    ec_view *view;
    ec_watch watch;
    ec_view_scene *scene;
    uint32_t loads, reloads, file_events;
    made_for made[EC_ROLE_COUNT];
} loader;

static void say_loading(ec_view *view, const char *what)
{
    pthread_mutex_lock(&view->lock);
    snprintf(view->status.loading, sizeof view->status.loading, "%s", what);
    ec_view_post(view);
    pthread_mutex_unlock(&view->lock);
}

/* What fails at first ends the program; later it leaves the last picture. */
static void say_failure(ec_view *view, ec_view_trouble whose, const ec_error *err, bool is_first)
{
    pthread_mutex_lock(&view->lock);
    if (is_first) view->fatal = *err, view->failed = true;
    pthread_mutex_unlock(&view->lock);
    ec_view_say_trouble(view, whose, err);
}

static ec_result find_facts(ec_view_scene *s, ec_view_facts *f, ec_error *err)
{
    const ec_scene *scene = s->scene;
    ec_effects effects;
    *f = (ec_view_facts){.serial = s->serial, .camera = s->options.camera, .width = s->options.width, .height = s->options.height,
                         .camera_count = scene->camera_count, .has_map = scene->environment.rgb != NULL, .scene = s};
    f->cameras = s->cameras = calloc(scene->camera_count, sizeof *s->cameras);
    if (!s->cameras) return ec_fail(err, "out of memory for %u cameras", scene->camera_count);
    for (uint32_t i = 0; i < f->camera_count; i++) {
        const ec_camera *camera = &scene->cameras[i];
        double reach = ec_camera_reach(scene, camera);
        if (i == f->camera) reach = fmin(reach, ec_view_pick(scene, camera, 1, 1, 0, 0).distance); /* what one looks at */
        ec_camera_viewpoint(camera, scene->center, reach, &s->cameras[i]);
    }
    for (int k = 0; k < 3; k++) {
        double half = 0.5 * ((double)scene->bounds_max[k] - scene->bounds_min[k]);
        f->center[k] = 0.5 * ((double)scene->bounds_max[k] + scene->bounds_min[k]) + scene->center[k];
        f->radius += half * half;
    }
    f->radius = f->radius > 0 ? sqrt(f->radius) : 1;
    if (ec_scene_calls(scene, &effects, NULL) == EC_OK) f->optional = s->optional = effects.bits & ec_effects_optional;
    return EC_OK;
}

/* A camera that nobody moved stays where it was too, whatever the file says now. */
static void keep_camera(ec_view *view, const ec_view_facts *now)
{
    const ec_view_facts *old = &view->facts;
    ec_view_wish *wish = &view->wish;
    if (!old->serial) wish->camera = view->asked.camera = now->camera;
    if (!old->serial || wish->moved) return;
    const ec_viewpoint *was = &old->cameras[wish->camera];
    if (wish->camera < now->camera_count && !memcmp(was, &now->cameras[wish->camera], sizeof *was)) return;
    wish->viewpoint = *was;
    ec_orbit_round(&wish->viewpoint); /* as the command prints it */
    wish->moved = true;
}

/* A picture that is whole is not given for one with white in the place of an image. */
static ec_result check_images(const loader *l, const ec_scene *scene, ec_error *err)
{
    bool was_whole = l->scene && !l->scene->scene->lost_image;
    return was_whole && scene->lost_image ? ec_fail(err, "%s: %.1200s", l->view->request->scene, scene->lost_image) : EC_OK;
}

static ec_result load(loader *l, ec_error *err)
{
    ec_view *view = l->view;
    const ec_view_request *request = view->request;
    ec_watch_stop(&l->watch);
    ec_watch_start(&l->watch, request->scene, request->environment, view->files);
    ec_view_scene *s = calloc(1, sizeof *s);
    if (!s) return ec_fail(err, "out of memory for a scene");
    *s = (ec_view_scene){.users = 1, .serial = ++l->loads, .options = request->options};
    ec_result result = request->load(request->user, &s->scene, &s->options, err);
    ec_view_facts facts;
    if (result == EC_OK) result = check_images(l, s->scene, err);
    if (result == EC_OK) result = find_facts(s, &facts, err);
    if (result != EC_OK) {
        ec_view_scene_release(view, s);
        return result;
    }
    ec_view_scene *old = l->scene;
    pthread_mutex_lock(&view->lock);
    keep_camera(view, &facts);
    view->facts = facts;
    l->scene = s;
    ec_view_post(view);
    pthread_mutex_unlock(&view->lock);
    ec_view_scene_release(view, old);
    ec_error lost = {0};
    if (s->scene->lost_image) ec_fail(&lost, "%s: %.1200s; taken as white", request->scene, s->scene->lost_image);
    ec_view_say_trouble(view, EC_TROUBLE_FILES, &lost);
    return EC_OK;
}

static void hand_over(ec_view *view, uint32_t role, ec_view_setup *setup)
{
    pthread_mutex_lock(&view->lock);
    ec_view_setup *unclaimed = view->incoming[role];
    view->incoming[role] = setup;
    ec_view_post(view);
    pthread_mutex_unlock(&view->lock);
    ec_view_setup_free(view, unclaimed);
}

/* false: it failed, and will not be tried again until something else is wished. */
static bool set_up(loader *l, uint32_t role, ec_integrator integrator, uint64_t without)
{
    ec_view_setup *setup;
    ec_error err = {0};
    bool is_first = l->made[role].serial == 0 && role == EC_ROLE_PICTURE;
    l->made[role] = (made_for){l->scene->serial, integrator, without};
    if (ec_view_setup_make(l->view, l->scene, integrator, without, &setup, &err) != EC_OK) {
        say_failure(l->view, EC_TROUBLE_SETUP, &err, is_first);
        return false;
    }
    ec_view_say_trouble(l->view, EC_TROUBLE_SETUP, NULL);
    hand_over(l->view, role, setup);
    return true;
}

static bool is_made(const loader *l, uint32_t role, ec_integrator integrator, uint64_t without)
{
    const made_for *m = &l->made[role];
    return m->serial == l->scene->serial && m->integrator == integrator && m->without == without;
}

/* Kernels whose compiling has begun would hold up those of the rasteriser, which some drivers compile as they are launched: PoCL has
 * one lock for all. */
static void wait_for_light(ec_view *view)
{
    pthread_mutex_lock(&view->lock);
    while (!view->quit && view->status.pictures == 0 && !*view->status.trouble[EC_TROUBLE_CAMERA] && !view->wish.paused)
        pthread_cond_wait(&view->changed, &view->lock);
    pthread_mutex_unlock(&view->lock);
}

/* First light comes from the rasteriser: nothing is built or compiled as fast. */
static void serve(loader *l, const ec_view_wish *wish)
{
    if (!is_made(l, EC_ROLE_PICTURE, wish->integrator, wish->without)) {
        bool first = l->made[EC_ROLE_PICTURE].serial == 0;
        if (first && wish->integrator != EC_INTEGRATOR_RASTER) {
            if (!set_up(l, EC_ROLE_PICTURE, EC_INTEGRATOR_RASTER, wish->without)) return;
            wait_for_light(l->view);
        }
        say_loading(l->view, "building kernels and structures");
        set_up(l, EC_ROLE_PICTURE, wish->integrator, wish->without);
    } else if (wish->has_second && wish->second == EC_SECOND_RUNG && !is_made(l, EC_ROLE_SECOND, wish->rung, wish->without)) {
        say_loading(l->view, "building the other rung");
        set_up(l, EC_ROLE_SECOND, wish->rung, wish->without);
    }
    say_loading(l->view, "");
}

static bool is_served(const loader *l, const ec_view_wish *wish)
{
    bool second = !wish->has_second || wish->second != EC_SECOND_RUNG || is_made(l, EC_ROLE_SECOND, wish->rung, wish->without);
    return second && is_made(l, EC_ROLE_PICTURE, wish->integrator, wish->without);
}

/* Until there is something to do, and for no reason else. true: it is time to look at the files. */
static bool wait_for_work(loader *l, bool pending, ec_view_wish *wish, bool *quit)
{
    ec_view *view = l->view;
    bool timed = pending || l->watch.is_deaf, late = false;
    struct timespec until = ec_deadline(pending ? SETTLES : DEAF_LOOKS);
    pthread_mutex_lock(&view->lock);
    while (!view->quit && !late && is_served(l, &view->wish) && l->reloads == view->wish.reloads &&
           l->file_events == view->file_events)
        late = (timed ? pthread_cond_timedwait(&view->changed, &view->lock, &until)
                      : pthread_cond_wait(&view->changed, &view->lock)) != 0;
    *wish = view->wish;
    *quit = view->quit;
    bool told = l->file_events != view->file_events;
    l->file_events = view->file_events;
    pthread_mutex_unlock(&view->lock);
    return late || told;
}

/* Whoever writes a file may not be done yet: only what stays the same from one look to the next is read. */
static void reload_if_changed(loader *l, bool *pending)
{
    if (ec_watch_changed(&l->watch)) {
        *pending = true;
        return;
    }
    if (!*pending) return;
    *pending = false;
    ec_error err = {0};
    say_loading(l->view, "loading");
    if (load(l, &err) != EC_OK) say_failure(l->view, EC_TROUBLE_FILES, &err, false);
    say_loading(l->view, "");
}

void *ec_view_loader(void *argument)
{
    ec_view *view = argument;
    loader l = {.view = view};
    ec_error err = {0};
    bool pending = false;
    say_loading(view, "loading");
    bool loaded = load(&l, &err) == EC_OK;
    if (!loaded) say_failure(view, EC_TROUBLE_FILES, &err, true);
    for (bool quit = !loaded; !quit;) {
        ec_view_wish wish;
        bool look = wait_for_work(&l, pending, &wish, &quit);
        if (quit) break;
        if (l.reloads != wish.reloads) l.reloads = wish.reloads, pending = look = true;
        if (look) reload_if_changed(&l, &pending);
        if (!is_served(&l, &wish)) serve(&l, &wish);
    }
    ec_watch_stop(&l.watch);
    ec_view_scene_release(view, l.scene);
    return NULL;
}
