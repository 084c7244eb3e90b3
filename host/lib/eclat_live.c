/* A job becomes a live session. */
#include <stdlib.h>
#include <string.h>

#include "lib/internal.h"
#include "live/shared.h"

struct eclat_live {
    ec_live session;
    eclat_job *options;   /* a copy, whose texts the session's request points to. Owned */
    ec_lib_ear ear;
    eclat_facts facts;    /* as the caller got them */
    ec_live_scene *scene; /* theirs; a user of it */
};

static ec_result open_session(eclat_live *live, const char *against, ec_error *err)
{
    ec_live *session = &live->session;
    const ec_given_options *given = &session->given;
    EC_TRY(ec_lib_read_options(live->options, &session->request, &session->given, err));
    for (int i = 0; i < given->count; i++)
        if (ec_render_row(given->list[i].option)->not_in_window) return ec_render_refuse_live(NULL, given->list[i].option, NULL, err);
    live->ear.listener = &live->options->listener;
    session->listener = ec_lib_listener(&live->ear);
    return ec_live_open(session, against, err);
}

eclat_result eclat_live_open(const eclat_job *job, const char *against, const eclat_live_listener *listener, eclat_live **live, eclat_error *err)
{
    ec_error why = {0};
    eclat_live *made = calloc(1, sizeof *made);
    *live = NULL;
    if (made) made->options = ec_lib_job_copy(job);
    ec_result result = made && made->options ? EC_OK : ec_fail(&why, "out of memory for a live session");
    if (result == EC_OK) made->options->listener = job->listener;
    if (result == EC_OK && listener) made->session.hears = *listener;
    if (result == EC_OK) result = open_session(made, against, &why);
    if (result == EC_OK) *live = made;
    else if (made) {
        eclat_job_free(made->options);
        free(made);
    }
    return ec_lib_end(result, &why, err);
}

void eclat_live_close(eclat_live *live)
{
    if (!live) return;
    ec_live_scene_release(&live->session, live->scene);
    ec_live_close(&live->session);
    eclat_job_free(live->options);
    free(live);
}

/* The caller alone changes it. */
eclat_wish eclat_live_wished(const eclat_live *live) { return live->session.asked.wish; }

/* is_saved: its picture is to be. Returns the number of saves that were asked for. */
static uint32_t wish_for(ec_live *session, eclat_wish *wish, bool is_saved)
{
    ec_live_asked *asked = &session->asked;
    ec_live_limit_wish(wish);
    pthread_mutex_lock(&session->lock);
    bool is_other = memcmp(&asked->wish, wish, sizeof *wish) != 0;
    if (is_other) asked->wish = *wish, asked->serial++;
    if (is_saved) asked->saved = *wish, asked->saves++;
    if (is_other || is_saved) ec_live_post(session);
    pthread_mutex_unlock(&session->lock);
    return asked->saves;
}

void eclat_live_wish(eclat_live *live, eclat_wish *wish) { wish_for(&live->session, wish, false); }
uint32_t eclat_live_save(eclat_live *live, eclat_wish *wish) { return wish_for(&live->session, wish, true); }

uint32_t eclat_live_pick(eclat_live *live, uint32_t x, uint32_t y)
{
    ec_live *session = &live->session;
    pthread_mutex_lock(&session->lock);
    session->asked.pick_x = x;
    session->asked.pick_y = y;
    session->asked.picks++;
    ec_live_post(session);
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
