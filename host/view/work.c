/* The renderer's steps: previews of few pixels, batches of the film, another rung, and what is shown of them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "film/resolve.h"
#include "pack/called_effects.h"
#include "view/renderer.h"
#include "view/slice.h"

static void tell(ec_renderer *r, uint32_t preview, bool has_second)
{
    const ec_view_picture *p = &r->picture;
    pthread_mutex_lock(&r->view->lock);
    ec_view_status *s = &r->view->status;
    s->preview = preview;
    s->integrator = r->setup[EC_ROLE_PICTURE]->options.integrator;
    s->samples = ec_view_picture_samples(p);
    s->seconds = p->seconds;
    s->error = p->film.batch_count ? p->error.error : INFINITY;
    s->error_bound = p->film.batch_count ? p->error.error_bound : INFINITY;
    s->forecast = p->goal.forecast;
    s->spp_limit = p->limits.spp;
    s->time_limit = p->limits.time_limit;
    s->error_limit = p->limits.error_target;
    if (!preview || s->second != EC_SECOND_FILE) s->second = has_second ? r->wish.second : EC_SECOND_COUNT; /* a file's is of any camera */
    if (r->setup[EC_ROLE_SECOND]) s->rung = r->setup[EC_ROLE_SECOND]->options.integrator;
    s->done = p->film.batch_count && p->stopped_by;
    ec_renderer_read_pixel(&p->film, &s->probe);
    snprintf(s->stopped_by, sizeof s->stopped_by, "%s", p->stopped_by ? p->stopped_by : "");
    ec_feature_names(r->setup[EC_ROLE_PICTURE]->stats.effects.called.bits, s->effects, sizeof s->effects);
    ec_view_post(r->view);
    pthread_mutex_unlock(&r->view->lock);
}

/* Looks through role's session with so many pixels. */
static ec_result look(ec_renderer *r, uint32_t role, uint32_t width, uint32_t height, ec_error *err)
{
    const ec_session_view look = {r->camera, width, height, r->wish.env_degrees};
    return ec_session_look(r->setup[role]->session, &look, err);
}

static ec_result make_room(ec_renderer *r, ec_error *err)
{
    uint64_t pixels = (uint64_t)r->wish.width * r->wish.height;
    if (pixels <= r->room) return EC_OK;
    free(r->mean);
    r->room = 0;
    r->mean = malloc(pixels * 3 * sizeof(float));
    if (!r->mean) return ec_fail(err, "out of memory for a picture of %ux%u pixels", r->wish.width, r->wish.height);
    r->room = pixels;
    return EC_OK;
}

ec_result ec_renderer_start_afresh(ec_renderer *r, ec_error *err)
{
    ec_view_picture_stop(&r->picture);
    ec_view_others_forget(&r->others);
    const ec_scene *scene = r->setup[EC_ROLE_PICTURE]->scene->scene;
    uint32_t index = r->wish.camera < scene->camera_count ? r->wish.camera : scene->default_camera;
    r->camera = scene->cameras[index];
    if (r->wish.moved) EC_TRY(ec_camera_look(&r->wish.viewpoint, scene->center, &r->camera, err));
    r->looked_away = true;
    double rate = ec_session_rate(r->setup[EC_ROLE_PICTURE]->session), pixels = (double)r->wish.width * r->wish.height;
    double level = rate > 0 ? ceil(sqrt(pixels / (rate * EC_VIEW_FOLLOWS))) : EC_VIEW_COARSEST / 2;
    r->level = (uint32_t)fmin(fmax(level, 1), EC_VIEW_COARSEST);
    r->dirty = false;
    r->aside = true;
    return make_room(r, err);
}

/* Between waves: is what is being done still wanted? Cursors and saves are answered by the way. */
static bool go_on(void *user)
{
    ec_renderer *r = user;
    ec_view *view = r->view;
    pthread_mutex_lock(&view->lock);
    const ec_view_wish wish = view->wish, asked = view->asked;
    bool other = view->quit || view->incoming[EC_ROLE_PICTURE] || wish.paused || !ec_view_same_camera(&wish, &r->wish);
    pthread_mutex_unlock(&view->lock);
    if (r->picture.film.batch_count) ec_renderer_serve_save(r, &wish, &asked);
    if (other) return false;
    ec_renderer_probe(r, &wish);
    return true;
}

/* A picture of a sample a pixel, each for level x level of the window's. While the camera moves it is finished even if the camera has
 * moved on: else there would be none. */
ec_result ec_renderer_preview(ec_renderer *r, ec_error *err)
{
    ec_session *session = r->setup[EC_ROLE_PICTURE]->session;
    uint32_t width = (r->wish.width + r->level - 1) / r->level, height = (r->wish.height + r->level - 1) / r->level;
    ec_session_batch batch = {.seed = ec_session_seed(r->setup[EC_ROLE_PICTURE]->options.seed, 1, r->previews++), .samples = 1,
                              .go_on = r->wish.moving ? NULL : go_on, .user = r, .slice = EC_VIEW_SLICE, .rgb = r->mean};
    r->aside = true;
    EC_TRY(look(r, EC_ROLE_PICTURE, width, height, err));
    EC_TRY(ec_session_take(session, &batch, err));
    if (!batch.complete) return EC_OK;
    ec_view_show(r->view, &r->wish, EC_ROLE_PICTURE, r->mean, width, height);
    tell(r, r->level, false);
    if (!r->wish.moving) r->level = r->level > 3 ? r->level / 2 : 0;
    return EC_OK;
}

static ec_result start_film(ec_renderer *r, ec_error *err)
{
    ec_view_setup *s = r->setup[EC_ROLE_PICTURE];
    return ec_view_picture_start(&r->picture, &s->options, r->wish.more, r->wish.width, r->wish.height, err);
}

ec_result ec_renderer_take_batch(ec_renderer *r, ec_error *err)
{
    bool complete;
    if (!r->picture.film.width) EC_TRY(start_film(r, err));
    if (r->aside) EC_TRY(look(r, EC_ROLE_PICTURE, r->wish.width, r->wish.height, err));
    r->aside = false;
    EC_TRY(ec_view_picture_take(&r->picture, r->setup[EC_ROLE_PICTURE]->session, go_on, r, &complete, err));
    r->dirty |= complete;
    return EC_OK;
}

ec_result ec_renderer_take_second(ec_renderer *r, ec_error *err)
{
    EC_TRY(look(r, EC_ROLE_SECOND, r->wish.width, r->wish.height, err));
    EC_TRY(ec_view_others_render(&r->others, r->setup[EC_ROLE_SECOND]->session, r->wish.width, r->wish.height, go_on, r, err));
    r->dirty |= r->others.rung != NULL;
    return EC_OK;
}

/* The film as it is now, and what is to stand beside it. */
void ec_renderer_show(ec_renderer *r)
{
    ec_view_wish *wish = &r->wish;
    ec_film_resolve(&r->picture.film, r->mean, NULL);
    bool shown = ec_view_show(r->view, wish, EC_ROLE_PICTURE, r->mean, wish->width, wish->height);
    bool has_second = wish->has_second && ec_view_others_has(&r->others, wish->second, &r->picture.film);
    if (has_second) shown &= ec_view_others_show(&r->others, r->view, wish, &r->picture.film, r->mean);
    if (shown) r->dirty = false;
    tell(r, 0, has_second);
}
