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

ec_result ec_view_available(ec_error *err)
{
    (void)err;
    return EC_OK;
}

void ec_view_print_keys(void)
{
    puts("\nKeys and mouse");
    for (size_t i = 0; i < ec_view_key_count; i++) printf("  %-28s %s\n", ec_view_keys[i].shown, ec_view_keys[i].help);
}

void ec_view_post(ec_view *view)
{
    view->events++;
    pthread_cond_broadcast(&view->changed);
    if (view->has_window && !pthread_equal(pthread_self(), view->window)) glfwPostEmptyEvent();
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
    w->stopped = view->stopped;
    if (view->wish.moved && !w->input.wish.moved && view->facts.serial != w->input.facts.serial && w->input.facts.serial) { /* keep_camera of loader.c */
        wish->moved = true;
        wish->viewpoint = view->wish.viewpoint;
    }
    if (view->facts.serial != w->input.facts.serial) ec_view_input_learn(&w->input, &view->facts);
    if (memcmp(&view->wish, wish, sizeof *wish)) {
        view->wish = *wish;
        ec_view_post(view);
    }
    if (memcmp(&w->status, &view->status, sizeof w->status)) {
        w->status = view->status;
        w->dirty = true;
    }
    pthread_mutex_unlock(&view->lock);
    if (w->status.saves_done != saved) w->told_at = ec_now();
    if (w->selecting && w->status.probe.serial == w->selecting) {
        w->input.selected = w->status.probe;
        w->selecting = 0;
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
    if (w->view->request->script || flying || w->input.wish.moving || (w->dirty && !w->iconified)) return fmax(FRAME - (ec_now() - last), 0.0005);
    return w->telling ? fmax(w->told_at + TOLD_FOR - ec_now(), 0) + 0.001 : INFINITY;
}

/* Until the scene is there, or long enough. */
static void wait_for_size(ec_window *w, uint32_t *width, uint32_t *height)
{
    ec_view *view = w->view;
    double until = ec_now() + PATIENCE;
    for (bool known = false; !known && ec_now() < until;) {
        pthread_mutex_lock(&view->lock);
        known = view->facts.serial || view->failed;
        *width = view->facts.width;
        *height = view->facts.height;
        pthread_mutex_unlock(&view->lock);
        if (!known) usleep(2000);
    }
    if (*width == 0) *width = 16 * 60, *height = 9 * 60;
}

static void loop(ec_window *w)
{
    ec_view *view = w->view;
    double last = ec_now(), tick = last;
    uint32_t width = 0, height = 0;
    wait_for_size(w, &width, &height);
    if (!view->failed) ec_window_size(w, width, height);
    for (bool over = view->failed; !over;) {
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
        if (w->input.fullscreen != w->is_full) ec_window_fullscreen(w, w->input.fullscreen);
        exchange(w);
        w->dirty |= ec_view_textures_take(&w->textures, view);
        ec_view_textures_fit(&w->textures, view, (size_t)w->input.wish.width * w->input.wish.height * 3);
        if (w->dirty && !w->iconified && now - last >= 0.9 * FRAME) {
            ec_window_draw(w);
            ec_frames_add(&w->frames, view->request->script ? w->script.moves : w->input.wish.moving, w->status.pictures);
            last = now;
        }
        if (glfwWindowShouldClose(w->glfw)) w->input.quit = true;
        bool saving = w->input.wish.saves != w->status.saves_done && w->status.samples > 0 && !w->iconified && !*w->status.failure;
        over = view->failed || (w->input.quit && !saving) || w->stopped;
    }
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
    }
    pthread_mutex_lock(&view->lock);
    view->quit = true;
    view->has_window = false;
    ec_view_post(view);
    pthread_mutex_unlock(&view->lock);
    if (w.glfw) glfwHideWindow(w.glfw); /* a kernel that is being compiled is waited for out of sight */
    eventfd_write(view->leave, 1);
    pthread_join(view->watcher, NULL);
    pthread_join(view->loader, NULL);
    pthread_join(view->renderer, NULL);
    if (request->stats && result == EC_OK && !view->failed) ec_frames_print(&w.frames, view->status.first_light, stdout);
    ec_window_close(&w);
    return result;
}

ec_result ec_view_run(const ec_view_request *request, ec_error *err)
{
    ec_view view = {.request = request, .start = ec_now(), .window = pthread_self()};
    view.wish = (ec_view_wish){.integrator = request->options.integrator, .rung = EC_INTEGRATOR_RASTER, .without = request->options.without,
                               .exposure = request->exposure, .tonemap = request->tonemap, .env_degrees = request->env_degrees};
    view.status.probe.material = view.status.probe.node = -1;
    view.status.error = view.status.error_bound = INFINITY;
    pthread_mutex_init(&view.lock, NULL);
    pthread_cond_init(&view.changed, NULL);
    ec_result result = EC_OK;
    view.files = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    view.leave = eventfd(0, EFD_CLOEXEC);
    if (view.leave < 0) return ec_fail(err, "no descriptor for the preview window");
    if (pthread_create(&view.loader, NULL, ec_view_loader, &view) != 0) return ec_fail(err, "no thread for the preview window");
    if (pthread_create(&view.renderer, NULL, ec_view_renderer, &view) != 0) return ec_fail(err, "no thread for the preview window");
    if (pthread_create(&view.watcher, NULL, ec_view_watcher, &view) != 0) return ec_fail(err, "no thread for the preview window");
    result = run_window(&view, err);
    if (view.files >= 0) close(view.files);
    close(view.leave);
    for (int role = 0; role < EC_ROLE_COUNT; role++) ec_view_setup_free(&view, view.incoming[role]);
    if (result == EC_OK && view.failed) result = ec_fail(err, "%s", view.fatal.text);
    pthread_cond_destroy(&view.changed);
    pthread_mutex_destroy(&view.lock);
    return result;
}
