/* The window's loop: takes events, requests views, draws frames. Sleeps in glfwWaitEvents unless something moves. */
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "view/view.h"
#include "view/window.h"

#define TOLD_FOR 6        /* seconds for which the message of a save is shown */
#define FRAME (1.0 / 60)
#define RESTS_AFTER 0.12  /* seconds without a move after which the camera is at rest */
#define PATIENCE 0.35     /* seconds that the window waits for the scene, whose camera tells its width */

/* Global, since GLFW's state belongs to the process. */
static atomic_bool is_open;

static void wake(void)
{
    if (atomic_load(&is_open)) glfwPostEmptyEvent();
}

static void on_news(void *user) { (void)user, wake(); }

static void report_command(void *user, const char *command)
{
    const ec_view_request *request = user;
    char *line = malloc(strlen(command) + 2);
    if (line) request->report(request->user, strcat(strcpy(line, command), "\n"));
    free(line);
}

static void report_frames(const ec_window *w)
{
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    if (!to) return;
    ec_frames_print(&w->frames, w->status.first_light, to);
    if (fclose(to) == 0) w->request->report(w->request->user, text);
    free(text);
}

static bool key_at(size_t i, const char **shown, const char **help)
{
    if (i >= ec_view_key_count) return false;
    *shown = ec_view_keys[i].shown;
    *help = ec_view_keys[i].help;
    return true;
}

/* Requests the current view from the session, and takes what is new. */
static void exchange(ec_window *w)
{
    ec_view_input *in = &w->input;
    const uint32_t saves = w->status.saves;
    const double now = glfwGetTime();
    if (in->moved) w->moved_at = now, in->moved = false;
    if (now - w->moved_at > (w->drag < 0 ? RESTS_AFTER : 4 * RESTS_AFTER)) in->view.is_moving = false; /* during a drag the mouse may pause */
    in->view.is_paused = w->iconified;
    const eclat_facts *facts = eclat_live_facts(w->live);
    if (facts->serial != in->facts.serial) ec_view_input_learn(in, facts);
    eclat_live_set_view(w->live, &in->view);
    eclat_status status;
    eclat_live_status(w->live, &status);
    w->dirty |= memcmp(&w->status, &status, sizeof status) != 0;
    w->status = status;
    if (status.saves != saves) w->told_at = now;
    if (status.picks != w->picks) in->selected = status.picked;
    w->picks = status.picks;
    bool telling = w->told_at > 0 && now - w->told_at < TOLD_FOR;
    w->dirty |= telling != w->telling;
    w->telling = telling;
    in->under = status.under;
}

/* Returns seconds; INFINITY if only an event can bring something new. */
static double time_to_wait(const ec_window *w, double last)
{
    bool flying = w->s_down > 0 || w->flies;
    static const int keys[] = {GLFW_KEY_UP, GLFW_KEY_DOWN, GLFW_KEY_LEFT, GLFW_KEY_RIGHT, GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_DOWN};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) flying |= glfwGetKey(w->glfw, keys[i]) == GLFW_PRESS;
    if (w->request->script || flying || w->input.view.is_moving || (w->dirty && !w->iconified))
        return fmax(FRAME - (glfwGetTime() - last), 0.0005);
    return w->telling ? fmax(w->told_at + TOLD_FOR - glfwGetTime(), 0) + 0.001 : INFINITY;
}

/* Waits until the scene is loaded, or PATIENCE is over. Returns false if there will be no scene. */
static bool wait_for_size(ec_window *w, uint32_t *width, uint32_t *height)
{
    const double until = glfwGetTime() + PATIENCE;
    for (bool is_known = false; !is_known && glfwGetTime() < until;) {
        const eclat_facts *facts = eclat_live_facts(w->live);
        eclat_live_status(w->live, &w->status);
        is_known = facts->serial || w->status.has_failed;
        w->input.facts.scene = facts->scene;
        *width = facts->width;
        *height = facts->height;
        if (!is_known) usleep(2000);
    }
    if (*width == 0) *width = 16 * 60, *height = 9 * 60;
    return !w->status.has_failed;
}

/* Returns why no picture will come; NULL: one will. */
static const char *why_stuck(const eclat_status *s)
{
    const char *camera = s->trouble[ECLAT_TROUBLE_CAMERA], *setup = s->trouble[ECLAT_TROUBLE_SETUP];
    return *camera ? camera : *setup ? setup : NULL;
}

static bool is_over(const ec_window *w)
{
    const char *stuck = why_stuck(&w->status);
    bool is_saving = w->input.saves != w->status.saves && !w->iconified && !stuck;
    return (w->input.quit && !is_saving) || w->request->should_stop(w->request->user) || w->status.has_failed || (w->request->script && stuck);
}

static void loop(ec_window *w)
{
    double last = glfwGetTime(), tick = last;
    uint32_t width = 0, height = 0;
    bool over = !wait_for_size(w, &width, &height);
    if (!over) ec_window_size(w, width, height);
    while (!over) {
        double wait = time_to_wait(w, last);
        if (isfinite(wait)) glfwWaitEventsTimeout(wait);
        else glfwWaitEvents();
        ec_window_fly(w);
        double now = glfwGetTime();
        if (w->request->script && w->input.facts.serial && now - last >= 0.9 * FRAME) {
            ec_script_run(&w->script, &w->input, &w->status, now - tick);
            tick = now;
            w->dirty = true;
        }
        ec_window_follow_monitors(w);
        if (w->input.fullscreen != w->is_full) ec_window_fullscreen(w, w->input.fullscreen);
        ec_window_point(w);
        exchange(w);
        w->dirty |= ec_view_textures_take(&w->textures, w->live);
        if (w->dirty && !w->iconified && now - last >= 0.9 * FRAME) {
            ec_window_draw(w);
            ec_frames_add(&w->frames, glfwGetTime(), w->request->script ? w->script.moves : w->input.view.is_moving, w->status.pictures);
            last = now;
        }
        if (glfwWindowShouldClose(w->glfw)) w->input.quit = true;
        over = is_over(w);
    }
}

/* Reports errors that were found while the window was open. */
static eclat_result conclude(const ec_window *w, eclat_error *err)
{
    const eclat_status *s = &w->status;
    if (s->has_failed) return ec_view_fail(err, "%s", s->trouble[s->has_failed - 1]);
    if (w->request->script && why_stuck(s)) return ec_view_fail(err, "%s", why_stuck(s));
    if (w->input.saves != s->saves) return ec_view_fail(err, "not saved: the window was closed before the picture's first samples were complete");
    if (s->is_unsaved) return ec_view_fail(err, "%s", s->told);
    if (w->request->stats) report_frames(w);
    return ECLAT_OK;
}

static eclat_result run(const ec_view_request *request, eclat_error *err)
{
    const eclat_live_listener listener = {(void *)(uintptr_t)request, on_news, report_command};
    ec_window w = {.request = request};
    eclat_result result = eclat_live_open(request->job, request->against, &listener, &w.live, err);
    if (result != ECLAT_OK) return result;
    w.input = (ec_view_input){.live = w.live, .first = eclat_live_view(w.live), .second = ECLAT_SECOND_ERROR, .has_file = request->against != NULL,
                              .under = {.node = -1}, .selected = {.node = -1}};
    w.input.view = w.input.first;
    if (request->script) result = ec_script_read(&w.script, request->script, err);
    if (result == ECLAT_OK) result = ec_window_open(&w, err);
    if (result == ECLAT_OK) {
        atomic_store(&is_open, true);
        loop(&w);
        glfwHideWindow(w.glfw); /* hidden before waiting for a kernel that is being compiled */
        result = conclude(&w, err);
        atomic_store(&is_open, false);
    }
    eclat_live_close(w.live);
    ec_window_close(&w);
    return result;
}

const ec_view_module ec_module = {run, wake, key_at};
