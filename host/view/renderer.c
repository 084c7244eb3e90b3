/* The renderer's thread: while the camera moves pictures of few pixels, each in EC_VIEW_FOLLOWS; once it rests finer ones, then the
 * film. A thread of its own rather than slices between the window's frames, so that the window keeps its pace whatever a wave
 * takes; waves are capped all the same, since a new wish is looked at only between two of them. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/renderer.h"

bool ec_view_same_camera(const ec_view_wish *a, const ec_view_wish *b)
{
    return a->moved == b->moved && a->camera == b->camera && a->width == b->width && a->height == b->height &&
           a->env_degrees == b->env_degrees && (!a->moved || !memcmp(&a->viewpoint, &b->viewpoint, sizeof a->viewpoint));
}

static bool same_tones(const ec_view_wish *a, const ec_view_wish *b)
{
    return a->exposure == b->exposure && a->tonemap == b->tonemap && a->second == b->second && a->has_second == b->has_second;
}

static void fail(ec_renderer *r, const ec_error *err)
{
    r->broken = true;
    ec_view_say_trouble(r->view, EC_TROUBLE_CAMERA, err);
}

static bool is_final(const ec_renderer *r)
{
    return r->setup[EC_ROLE_PICTURE]->options.integrator == r->wish.integrator;
}

typedef enum duty { QUIT, WAIT, REST, PREVIEW, SECOND, BATCH, SHOW } duty;

static duty choose(const ec_renderer *r)
{
    const ec_view_wish *w = &r->wish;
    bool has_film = r->picture.film.batch_count > 0, needs_rung = w->has_second && w->second == EC_SECOND_RUNG && !r->others.rung;
    if (!r->setup[EC_ROLE_PICTURE] || !w->width || w->paused) return WAIT;
    if (r->level) return r->broken ? WAIT : PREVIEW;
    if (!is_final(r)) return WAIT;
    if (r->dirty) return SHOW;
    if (r->broken) return WAIT;
    if (has_film && needs_rung && r->setup[EC_ROLE_SECOND]) return SECOND;
    if (!r->picture.stopped_by) return BATCH;
    return needs_rung || w->moving || r->setup[EC_ROLE_PICTURE]->without != w->without ? WAIT : REST;
}

/* Copies the wish; other cameras, sessions and tones than before mean other work. */
static duty take_wish(ec_renderer *r, ec_error *err)
{
    ec_view *view = r->view;
    ec_view_setup *old[EC_ROLE_COUNT] = {NULL};
    pthread_mutex_lock(&view->lock);
    const ec_view_wish wish = view->wish, asked = view->asked;
    bool quit = view->quit;
    pthread_mutex_unlock(&view->lock);
    if (quit) return QUIT;
    ec_renderer_serve_save(r, &wish, &asked);
    pthread_mutex_lock(&view->lock);
    bool swapped = view->incoming[EC_ROLE_PICTURE] != NULL;
    for (int role = 0; role < EC_ROLE_COUNT; role++) {
        if (!view->incoming[role]) continue;
        old[role] = r->setup[role];
        r->setup[role] = view->incoming[role];
        view->incoming[role] = NULL;
        if (role == EC_ROLE_SECOND) ec_view_others_forget(&r->others);
    }
    pthread_mutex_unlock(&view->lock);
    for (int role = 0; role < EC_ROLE_COUNT; role++) ec_view_setup_free(view, old[role]);
    bool afresh = swapped || !ec_view_same_camera(&wish, &r->wish), rested = r->wish.moving && !wish.moving;
    bool repaint = !same_tones(&wish, &r->wish), more = wish.more != r->wish.more;
    r->wish = wish;
    if (afresh) r->broken = false; /* of that camera, or device: the next may do */
    if (!r->setup[EC_ROLE_PICTURE] || !wish.width) return WAIT;
    if (afresh && ec_renderer_start_afresh(r, err) != EC_OK) {
        fail(r, err);
        return WAIT;
    }
    if (rested && r->level > 1) r->level /= 2;
    if (more && r->picture.film.batch_count) ec_view_picture_limit(&r->picture, &r->setup[EC_ROLE_PICTURE]->options, wish.more);
    if (repaint && r->picture.film.batch_count) r->dirty = true;
    else if (repaint && !r->level) r->level = 1;
    ec_renderer_probe(r, &wish);
    return choose(r);
}

static ec_result do_duty(ec_renderer *r, duty d, ec_error *err)
{
    if (d == PREVIEW) return ec_renderer_preview(r, err);
    if (d == BATCH) return ec_renderer_take_batch(r, err);
    if (d == SECOND) return ec_renderer_take_second(r, err);
    if (d == SHOW) ec_renderer_show(r);
    if (d == SHOW && !r->broken) ec_view_say_trouble(r->view, EC_TROUBLE_CAMERA, NULL);
    return EC_OK;
}

static void settle(const ec_renderer *r)
{
    ec_view_status *s = &r->view->status;
    pthread_mutex_lock(&r->view->lock);
    if (s->settled != r->wish.serial) {
        s->settled = r->wish.serial;
        ec_view_post(r->view);
    }
    pthread_mutex_unlock(&r->view->lock);
}

static void wait_for_events(ec_view *view, uint64_t *seen)
{
    pthread_mutex_lock(&view->lock);
    while (*seen == view->events && !view->quit) pthread_cond_wait(&view->changed, &view->lock);
    *seen = view->events;
    pthread_mutex_unlock(&view->lock);
}

void *ec_view_renderer(void *argument)
{
    ec_renderer r = {.view = argument};
    ec_error err = {0};
    uint64_t seen = 0;
    ec_view_others_open(&r.others, r.view->request->against);
    for (duty d; (d = take_wish(&r, &err)) != QUIT;) {
        if (d == REST) settle(&r);
        if (d == WAIT || d == REST) wait_for_events(r.view, &seen);
        else if (do_duty(&r, d, &err) != EC_OK) fail(&r, &err);
        else if (r.dirty && d == SHOW) wait_for_events(r.view, &seen); /* all slots are on their way */
    }
    for (int role = 0; role < EC_ROLE_COUNT; role++) ec_view_setup_free(r.view, r.setup[role]);
    ec_view_picture_stop(&r.picture);
    ec_view_others_close(&r.others);
    free(r.mean);
    return NULL;
}
