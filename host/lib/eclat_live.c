/* Makes a live session of a job. */
#include <stdlib.h>
#include <string.h>

#include "lib/internal.h"
#include "live/shared.h"

struct eclat_live {
    ec_live session;
    char *scene_path;         /* owned; the request points to it and into the session's options */
    eclat_listener listener;
    ec_lib_ear ear;
    eclat_facts facts;        /* as last returned to the caller */
    ec_live_scene *scene;     /* the scene of these facts, of which this is a user */
};

static ec_result read_job(eclat_live *live, const eclat_job *job, ec_error *err)
{
    ec_live *session = &live->session;
    bool is_given[EC_OPTIONS_MAX] = {false};
    if (strcmp(job->command->told.name, "render")) return ec_usage(err, "a live session shows a job of the command render, not of %s", job->command->told.name);
    if (job->input_count != 1) return ec_usage(err, "a live session needs a job with one scene");
    for (int i = 0; i < job->given.count; i++)
        if (ec_render_row(job->given.list[i].option)->not_in_window) return ec_render_refuse_live(NULL, job->given.list[i].option, NULL, err);
    EC_TRY(ec_given_add_all(&session->given, &job->given, job->rows, job->row_count, 0, err));
    live->scene_path = strdup(job->inputs[0]);
    if (!live->scene_path) return ec_fail(err, "out of memory for a live session");
    ec_render_request_start(&session->request);
    EC_TRY(ec_given_apply(&session->given, job->rows, job->row_count, &session->request, is_given, err));
    session->request.scene = live->scene_path;
    return ec_render_request_settle(&session->request, job->rows, job->row_count, is_given, err);
}

static void free_live(eclat_live *live)
{
    ec_given_free(&live->session.given);
    free(live->scene_path);
    free(live);
}

eclat_result eclat_live_open(const eclat_job *job, const char *against, const eclat_live_listener *listener, eclat_live **live, eclat_error *err)
{
    ec_error why = {0};
    eclat_live *made = calloc(1, sizeof *made);
    *live = NULL;
    if (!made) return ec_lib_end(ec_fail(&why, "out of memory for a live session"), &why, err);
    made->listener = job->listener;
    made->ear.listener = &made->listener;
    made->ear.is_quiet = ec_given_has(&job->given, "quiet");
    made->session.listener = ec_lib_listener(&made->ear);
    if (listener) made->session.hears = *listener;
    ec_result result = read_job(made, job, &why);
    if (result == EC_OK) result = ec_live_open(&made->session, against, &why);
    if (result == EC_OK) *live = made;
    else free_live(made);
    return ec_lib_end(result, &why, err);
}

void eclat_live_close(eclat_live *live)
{
    if (!live) return;
    ec_live_scene_release(&live->session, live->scene);
    ec_live_close(&live->session);
    free_live(live);
}

/* No lock is needed, as only the caller changes it. */
eclat_view_request eclat_live_view(const eclat_live *live) { return live->session.asked.view; }

/* Replaces the requested view. is_saved: its picture is to be saved. Returns the number of saves asked for so far. */
static uint32_t replace_view(ec_live *session, eclat_view_request *view, bool is_saved)
{
    ec_live_asked *asked = &session->asked;
    ec_live_limit_view(view);
    pthread_mutex_lock(&session->lock);
    bool is_other = memcmp(&asked->view, view, sizeof *view) != 0;
    if (is_other) asked->view = *view, asked->serial++;
    if (is_saved) asked->saved = *view, asked->saves++;
    if (is_other || is_saved) ec_live_wake(session);
    pthread_mutex_unlock(&session->lock);
    return asked->saves;
}

void eclat_live_set_view(eclat_live *live, eclat_view_request *view) { replace_view(&live->session, view, false); }
uint32_t eclat_live_save(eclat_live *live, eclat_view_request *view) { return replace_view(&live->session, view, true); }

uint32_t eclat_live_pick(eclat_live *live, uint32_t x, uint32_t y)
{
    ec_live *session = &live->session;
    pthread_mutex_lock(&session->lock);
    session->asked.pick_x = x;
    session->asked.pick_y = y;
    session->asked.picks++;
    ec_live_wake(session);
    pthread_mutex_unlock(&session->lock);
    return session->asked.picks;
}

const eclat_facts *eclat_live_facts(eclat_live *live)
{
    ec_live *session = &live->session;
    pthread_mutex_lock(&session->lock);
    ec_live_scene *before = live->scene;
    live->facts = session->facts;
    live->scene = session->scene;
    if (live->scene) live->scene->users++;
    pthread_mutex_unlock(&session->lock);
    ec_live_scene_release(session, before);
    return &live->facts;
}

void eclat_live_status(eclat_live *live, eclat_status *status)
{
    ec_live *session = &live->session;
    pthread_mutex_lock(&session->lock);
    const ec_live_asked *asked = &session->asked;
    *status = session->status;
    status->is_settled = session->settled == asked->serial && status->saves == asked->saves && !*status->loading;
    pthread_mutex_unlock(&session->lock);
}

int eclat_live_take(eclat_live *live, eclat_shown which, eclat_image *image)
{
    ec_live *session = &live->session;
    ec_live_shown *shown = &session->shown[which];
    pthread_mutex_lock(&session->lock);
    const bool is_new = shown->is_new;
    if (is_new) {
        const ec_live_image ready = shown->ready;
        shown->ready = shown->taken;
        shown->taken = ready;
        shown->is_new = false;
        *image = (eclat_image){ready.width, ready.height, ready.rgb};
    }
    pthread_mutex_unlock(&session->lock);
    return is_new;
}
