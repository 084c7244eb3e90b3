/* The window's thread: events in, wishes out, frames on the screen. It sleeps in glfwWaitEvents unless something moves. */
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "base/clock.h"
#include "view/window.h"

#define TOLD_FOR 6        /* seconds that the message of a save is shown */
#define FRAME (1.0 / 60)
#define RESTS_AFTER 0.12  /* seconds without a move */
#define PATIENCE 0.35     /* seconds that the window waits for the scene, whose camera says how wide it is */

bool ec_view_key_at(size_t i, const char **shown, const char **help)
{
    if (i >= ec_view_key_count) return false;
    *shown = ec_view_keys[i].shown;
    *help = ec_view_keys[i].help;
    return true;
}

void ec_view_post(ec_view *view)
{
    view->events++;
    pthread_cond_broadcast(&view->changed);
    if (view->has_window && !pthread_equal(pthread_self(), view->window)) glfwPostEmptyEvent();
}

void ec_view_say_trouble(ec_view *view, ec_view_trouble whose, const ec_error *err)
{
    char *said = view->status.trouble[whose];
    pthread_mutex_lock(&view->lock);
    bool other = strcmp(said, err ? err->text : "") != 0;
    snprintf(said, sizeof view->status.trouble[whose], "%s", err ? err->text : "");
    if (other) ec_view_post(view);
    pthread_mutex_unlock(&view->lock);
}

/* Takes over another scene, if there is one. Returns the one before, which is to be released once the lock is. */
static ec_view_scene *learn(ec_window *w)
{
    ec_view *view = w->view;
    ec_view_wish *wish = &w->input.wish;
    ec_view_scene *before = w->input.facts.scene;
    if (view->facts.serial == w->input.facts.serial) return NULL;
    if (view->wish.moved && !wish->moved && before) wish->moved = true, wish->viewpoint = view->wish.viewpoint; /* keep_camera of loader.c */
    view->facts.scene->users++;
    ec_view_input_learn(&w->input, &view->facts);
    return before;
}

/* Tells the others what is wished now, and learns what there is. */
static void exchange(ec_window *w)
{
    ec_view *view = w->view;
    ec_view_wish *wish = &w->input.wish;
    bool resting = wish->moving && w->drag < 0 && ec_now() - w->input.moved_at > RESTS_AFTER;
    bool pausing = w->drag >= 0 && ec_now() - w->input.moved_at > 4 * RESTS_AFTER; /* the hand holds still */
    if (resting || pausing) wish->moving = false;
    wish->paused = w->iconified;
    pthread_mutex_lock(&view->lock);
    uint32_t saved = w->status.saves_done;
    w->stopped = view->stopped || view->failed;
    ec_view_scene *before = learn(w);
    if (memcmp(&view->wish, wish, sizeof *wish)) {
        wish->serial++;
        view->wish = *wish;
        view->asked = w->input.asked;
        ec_view_post(view);
    }
    if (memcmp(&w->status, &view->status, sizeof w->status)) {
        w->status = view->status;
        w->dirty = true;
    }
    pthread_mutex_unlock(&view->lock);
    ec_view_scene_release(view, before);
    if (w->status.saves_done != saved) w->told_at = ec_now();
    if (w->status.clicked.serial != w->selected_by) {
        w->input.selected = w->status.clicked;
        w->selected_by = w->status.clicked.serial;
        w->dirty = true;
    }
    bool telling = w->told_at > 0 && ec_now() - w->told_at < TOLD_FOR;
    w->dirty |= telling != w->telling;
    w->telling = telling;
    w->input.under = w->status.probe;
}

/* Seconds; infinite where only an event can bring something new. */
static double time_to_wait(const ec_window *w, double last)
{
    bool flying = w->s_down > 0 || w->flies;
    static const int keys[] = {GLFW_KEY_UP, GLFW_KEY_DOWN, GLFW_KEY_LEFT, GLFW_KEY_RIGHT, GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_DOWN};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) flying |= glfwGetKey(w->glfw, keys[i]) == GLFW_PRESS;
    if (w->view->request->script || flying || w->input.wish.moving || (w->dirty && !w->iconified))
        return fmax(FRAME - (ec_now() - last), 0.0005);
    return w->telling ? fmax(w->told_at + TOLD_FOR - ec_now(), 0) + 0.001 : INFINITY;
}

/* Until the scene is there, or long enough. false: there will be none. */
static bool wait_for_size(ec_window *w, uint32_t *width, uint32_t *height)
{
    ec_view *view = w->view;
    double until = ec_now() + PATIENCE;
    bool failed = false;
    for (bool known = false; !known && ec_now() < until;) {
        pthread_mutex_lock(&view->lock);
        failed = view->failed;
        known = view->facts.serial || failed;
        *width = view->facts.width;
        *height = view->facts.height;
        pthread_mutex_unlock(&view->lock);
        if (!known) usleep(2000);
    }
    if (*width == 0) *width = 16 * 60, *height = 9 * 60;
    return !failed;
}

/* NULL, or why no picture will come. */
static const char *why_stuck(const ec_view_status *s)
{
    return *s->trouble[EC_TROUBLE_CAMERA] ? s->trouble[EC_TROUBLE_CAMERA] : *s->trouble[EC_TROUBLE_SETUP] ? s->trouble[EC_TROUBLE_SETUP] : NULL;
}

static bool is_saving(const ec_window *w)
{
    return w->input.wish.saves != w->status.saves_done;
}

static void loop(ec_window *w)
{
    ec_view *view = w->view;
    double last = ec_now(), tick = last;
    uint32_t width = 0, height = 0;
    bool over = !wait_for_size(w, &width, &height);
    if (!over) ec_window_size(w, width, height);
    while (!over) {
        double wait = time_to_wait(w, last);
        if (isfinite(wait)) glfwWaitEventsTimeout(wait);
        else glfwWaitEvents();
        ec_window_fly(w);
        double now = ec_now();
        if (view->request->script && w->input.facts.serial && now - last >= 0.9 * FRAME) {
            ec_script_run(&w->script, &w->input, &w->status, now - tick);
            tick = now;
            w->dirty = true;
        }
        ec_window_follow_monitors(w);
        if (w->input.fullscreen != w->is_full) ec_window_fullscreen(w, w->input.fullscreen);
        ec_window_point(w);
        exchange(w);
        w->dirty |= ec_view_textures_take(&w->textures, view);
        ec_view_textures_fit(&w->textures, view, (size_t)w->input.wish.width * w->input.wish.height * 3);
        if (w->dirty && !w->iconified && now - last >= 0.9 * FRAME) {
            ec_window_draw(w);
            ec_frames_add(&w->frames, view->request->script ? w->script.moves : w->input.wish.moving, w->status.pictures);
            last = now;
        }
        if (glfwWindowShouldClose(w->glfw)) w->input.quit = true;
        bool saving = is_saving(w) && !w->iconified && !why_stuck(&w->status);
        over = (w->input.quit && !saving) || w->stopped || (view->request->script && why_stuck(&w->status));
    }
}

static ec_result start_threads(ec_view *view, ec_error *err)
{
    void *(*const work[EC_VIEW_THREADS])(void *) = {ec_view_loader, ec_view_renderer, ec_view_watcher};
    for (; view->threads < EC_VIEW_THREADS; view->threads++)
        if (pthread_create(&view->thread[view->threads], NULL, work[view->threads], view) != 0)
            return ec_fail(err, "no thread for the preview window: end other programs, or raise `ulimit -u`");
    return EC_OK;
}

/* Those that there are; each at the end of what it is at. */
static void end_threads(ec_view *view)
{
    pthread_mutex_lock(&view->lock);
    view->quit = true;
    view->has_window = false;
    ec_view_post(view);
    pthread_mutex_unlock(&view->lock);
    eventfd_write(view->leave, 1);
    while (view->threads) pthread_join(view->thread[--view->threads], NULL);
}

static ec_result run_window(ec_view *view, ec_error *err)
{
    const ec_view_request *request = view->request;
    ec_window w = {.view = view};
    w.input = (ec_view_input){.request = request, .wish = view->wish, .under = {.node = -1}, .selected = {.node = -1}};
    ec_result result = EC_OK;
    if (request->script) result = ec_script_read(&w.script, request->script, err);
    if (result == EC_OK) result = ec_window_open(&w, view, err);
    if (result == EC_OK) {
        pthread_mutex_lock(&view->lock);
        view->has_window = true;
        pthread_mutex_unlock(&view->lock);
        loop(&w);
        const char *stuck = why_stuck(&w.status);
        if (request->script && stuck) result = ec_fail(err, "%s", stuck);
    }
    if (w.glfw) glfwHideWindow(w.glfw); /* a kernel that is being compiled is waited for out of sight */
    end_threads(view);
    const char *unsaved = is_saving(&w)
                              ? "not saved: the window was closed before the picture's first samples were there"
                              : w.status.unsaved;
    if (result == EC_OK && !view->failed && *unsaved) result = ec_fail(err, "%s", unsaved);
    ec_view_scene_release(view, w.input.facts.scene);
    if (request->stats && result == EC_OK && !view->failed) ec_frames_print(&w.frames, view->status.first_light, stdout);
    ec_window_close(&w);
    return result;
}

ec_result ec_view_run(const ec_view_request *request, ec_error *err)
{
    ec_view view = {.request = request, .start = ec_now(), .window = pthread_self()};
    view.wish = (ec_view_wish){.integrator = request->options.integrator, .rung = EC_INTEGRATOR_RASTER, .without = request->options.without,
                               .exposure = request->exposure, .tonemap = request->tonemap, .env_degrees = request->env_degrees};
    view.facts.width = request->options.width; /* as --size asks, until the scene is there */
    view.facts.height = request->options.height;
    view.status.probe.material = view.status.probe.node = -1;
    view.status.error = view.status.error_bound = INFINITY;
    view.status.second = EC_SECOND_COUNT;
    pthread_mutex_init(&view.lock, NULL);
    pthread_cond_init(&view.changed, NULL);
    view.files = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    view.leave = eventfd(0, EFD_CLOEXEC);
    if (view.leave < 0) return ec_fail(err, "no descriptor for the preview window");
    ec_result result = start_threads(&view, err);
    if (result == EC_OK) result = run_window(&view, err);
    else end_threads(&view);
    if (view.files >= 0) close(view.files);
    close(view.leave);
    for (int role = 0; role < EC_ROLE_COUNT; role++) ec_view_setup_free(&view, view.incoming[role]);
    if (result == EC_OK && view.failed) result = ec_fail(err, "%s", view.fatal.text);
    pthread_cond_destroy(&view.changed);
    pthread_mutex_destroy(&view.lock);
    return result;
}
