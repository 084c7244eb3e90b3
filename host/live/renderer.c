/* The renderer's thread: while the camera moves, takes pictures of few pixels in little time; when it rests, finer ones, then the film. Waves are
 * short, since new views are read only between two of them. */
#include <signal.h>
#include <stdlib.h>

#include "live/renderer.h"

static bool same_tones(const eclat_view_request *a, const eclat_view_request *b)
{
    return a->exposure == b->exposure && a->tonemap == b->tonemap && a->second == b->second;
}

static void fail(ec_renderer *r, const ec_error *err)
{
    r->broken = true;
    ec_live_say_trouble(r->live, ECLAT_TROUBLE_CAMERA, err->text, false);
}

static bool is_final(const ec_renderer *r)
{
    return (int)r->setup[ECLAT_PICTURE]->options.integrator == (int)r->view.integrator;
}

typedef enum duty { QUIT, WAIT, REST, PREVIEW, SECOND, BATCH, SHOW } duty;

static duty choose(const ec_renderer *r)
{
    const eclat_view_request *w = &r->view;
    bool has_film = r->picture.film.batch_count > 0, needs_other = w->second == ECLAT_SECOND_INTEGRATOR && !r->second.other;
    if (!r->setup[ECLAT_PICTURE] || !w->width || w->is_paused) return WAIT;
    if (r->level) return r->broken ? WAIT : PREVIEW;
    if (!is_final(r)) return WAIT;
    if (r->dirty) return SHOW;
    if (r->broken) return WAIT;
    if (has_film && needs_other && r->setup[ECLAT_SECOND_PICTURE]) return SECOND;
    if (!r->picture.stopped_by) return BATCH;
    return needs_other || w->is_moving || r->setup[ECLAT_PICTURE]->without != w->without ? WAIT : REST;
}

/* Takes over what the loader has made. Returns true if it is for the picture. */
static bool take_setups(ec_renderer *r)
{
    ec_live_setup *old[ECLAT_SHOWN_COUNT] = {NULL};
    pthread_mutex_lock(&r->live->lock);
    bool swapped = r->live->incoming[ECLAT_PICTURE] != NULL;
    for (int which = 0; which < ECLAT_SHOWN_COUNT; which++) {
        if (!r->live->incoming[which]) continue;
        old[which] = r->setup[which];
        r->setup[which] = r->live->incoming[which];
        r->live->incoming[which] = NULL;
        if (which == ECLAT_SECOND_PICTURE) ec_live_second_forget(&r->second);
    }
    pthread_mutex_unlock(&r->live->lock);
    for (int which = 0; which < ECLAT_SHOWN_COUNT; which++) ec_live_setup_free(r->live, old[which]);
    return swapped;
}

/* Copies the requested view, and decides what to do: a new camera, session or tone curve means other work. */
static duty take_view(ec_renderer *r, ec_error *err)
{
    pthread_mutex_lock(&r->live->lock);
    const ec_live_asked asked = r->live->asked;
    bool quit = r->live->quit;
    pthread_mutex_unlock(&r->live->lock);
    if (quit) return QUIT;
    const eclat_view_request *view = &asked.view;
    ec_renderer_serve_save(r, &asked);
    bool afresh = take_setups(r) || !ec_live_same_camera(view, &r->view), rested = r->view.is_moving && !view->is_moving;
    bool repaint = !same_tones(view, &r->view), more = view->more != r->view.more;
    r->view = *view;
    r->serial = asked.serial;
    if (afresh) r->broken = false; /* another camera or device may work */
    if (!r->setup[ECLAT_PICTURE] || !view->width) return WAIT;
    if (afresh && ec_renderer_start_afresh(r, err) != EC_OK) {
        fail(r, err);
        return WAIT;
    }
    if (rested && r->level > 1) r->level /= 2;
    if (more && r->picture.film.batch_count) ec_live_film_limit(&r->picture, &r->setup[ECLAT_PICTURE]->options, view->more);
    if (repaint && r->picture.film.batch_count) r->dirty = true;
    else if (repaint && !r->level) r->level = 1;
    ec_renderer_probe(r, &asked);
    return choose(r);
}

static ec_result do_duty(ec_renderer *r, duty d, ec_error *err)
{
    if (d == PREVIEW) return ec_renderer_preview(r, err);
    if (d == BATCH) return ec_renderer_take_batch(r, err);
    if (d == SECOND) return ec_renderer_take_second(r, err);
    EC_TRY(ec_renderer_show(r, err));
    if (!r->broken) ec_live_say_trouble(r->live, ECLAT_TROUBLE_CAMERA, "", false);
    return EC_OK;
}

static void settle(const ec_renderer *r)
{
    pthread_mutex_lock(&r->live->lock);
    bool is_new = r->live->settled != r->serial;
    r->live->settled = r->serial;
    if (is_new) ec_live_tell(r->live);
    pthread_mutex_unlock(&r->live->lock);
}

static void wait_for_events(ec_live *live, uint64_t *seen)
{
    pthread_mutex_lock(&live->lock);
    while (*seen == live->events && !live->quit) pthread_cond_wait(&live->changed, &live->lock);
    *seen = live->events;
    pthread_mutex_unlock(&live->lock);
}

/* Blocks SIGXFSZ, so that a file larger than `ulimit -f` allows is an error like others, whatever the process does with signals. */
static void ignore_file_size(void)
{
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGXFSZ);
    pthread_sigmask(SIG_BLOCK, &signals, NULL);
}

void *ec_live_renderer(void *argument)
{
    ec_renderer r = {.live = argument};
    ec_error err = {0};
    uint64_t seen = 0;
    ignore_file_size();
    for (duty d; (d = take_view(&r, &err)) != QUIT;) {
        if (d == REST) settle(&r);
        if (d == WAIT || d == REST) wait_for_events(r.live, &seen);
        else if (do_duty(&r, d, &err) != EC_OK) fail(&r, &err);
    }
    for (int which = 0; which < ECLAT_SHOWN_COUNT; which++) ec_live_setup_free(r.live, r.setup[which]);
    ec_live_film_stop(&r.picture);
    ec_live_second_close(&r.second);
    free(r.mean);
    return NULL;
}
