/* The renderer's thread: while the camera moves pictures of few pixels, each in EC_VIEW_FOLLOWS; once it rests finer ones, then the
 * film. A thread of its own rather than slices between the window's frames, so that the window keeps its pace whatever a wave
 * takes; waves are capped all the same, since a new wish is looked at only between two of them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "pack/effects.h"
#include "view/picture.h"
#include "view/second.h"
#include "view/slice.h"

typedef struct renderer {
    ec_view *view;
    ec_view_setup *setup[EC_ROLE_COUNT];
    ec_view_wish wish;          /* that is being worked at */
    ec_camera camera;
    uint32_t level;             /* pixels of a side for a sample; 0: the film's turn */
    uint32_t previews;
    bool aside;                 /* the session looks where a preview was taken, not where the film is */
    bool dirty;                 /* the film's picture is to be shown (again) */
    bool broken;                /* the device failed: waits for another setup */
    ec_view_picture picture;
    ec_view_others others;
    float *mean;                /* 3 a pixel, of room pixels */
    uint64_t room;
    uint32_t saves;
} renderer;

static bool same_camera(const ec_view_wish *a, const ec_view_wish *b)
{
    return a->moved == b->moved && a->camera == b->camera && a->width == b->width && a->height == b->height &&
           a->env_degrees == b->env_degrees && (!a->moved || !memcmp(&a->viewpoint, &b->viewpoint, sizeof a->viewpoint));
}

static bool same_tones(const ec_view_wish *a, const ec_view_wish *b)
{
    return a->exposure == b->exposure && a->tonemap == b->tonemap && a->second == b->second && a->has_second == b->has_second;
}

static void fail(renderer *r, const ec_error *err)
{
    ec_view *view = r->view;
    r->broken = true;
    pthread_mutex_lock(&view->lock);
    snprintf(view->status.failure, sizeof view->status.failure, "%s", err->text);
    ec_view_post(view);
    pthread_mutex_unlock(&view->lock);
}

/* What the film has of a probe's pixel. */
static void read_pixel(const ec_film *film, ec_view_probe *probe)
{
    probe->has_film = film->batch_count > 0 && probe->x < film->width && probe->y < film->height;
    probe->has_error = probe->has_film && film->batch_count > 1;
    if (!probe->has_film) return;
    uint64_t p = (uint64_t)probe->y * film->width + probe->x;
    double n = ec_film_batches(film, p);
    for (int c = 0; c < 3; c++) {
        probe->rgb[c] = film->mean[3 * p + c];
        probe->se[c] = n > 1 ? sqrt(film->m2[4 * p + c] / (n * (n - 1))) : 0;
    }
}

static void tell(renderer *r, uint32_t preview)
{
    const ec_view_picture *p = &r->picture;
    pthread_mutex_lock(&r->view->lock);
    ec_view_status *s = &r->view->status;
    s->preview = preview;
    s->integrator = r->setup[EC_ROLE_PICTURE]->options.integrator;
    s->samples = (uint64_t)p->film.batch_count * p->limits.batch;
    s->seconds = p->seconds;
    s->error = p->film.batch_count ? p->error.error : INFINITY;
    s->error_bound = p->film.batch_count ? p->error.error_bound : INFINITY;
    s->forecast = p->forecast;
    s->done = p->film.batch_count && p->stopped_by;
    read_pixel(&p->film, &s->probe);
    snprintf(s->stopped_by, sizeof s->stopped_by, "%s", p->stopped_by ? p->stopped_by : "");
    ec_feature_names(r->setup[EC_ROLE_PICTURE]->stats.effects.called.bits, s->effects, sizeof s->effects);
    ec_view_post(r->view);
    pthread_mutex_unlock(&r->view->lock);
}

/* Looks through role's session with so many pixels. */
static ec_result look(renderer *r, uint32_t role, uint32_t width, uint32_t height, ec_error *err)
{
    const ec_session_view look = {r->camera, width, height, r->wish.env_degrees};
    return ec_session_look(r->setup[role]->session, &look, err);
}

static ec_result make_room(renderer *r, ec_error *err)
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

/* What the next look shows is another picture. */
static ec_result start_afresh(renderer *r, ec_error *err)
{
    const ec_scene *scene = r->setup[EC_ROLE_PICTURE]->scene->scene;
    uint32_t index = r->wish.camera < scene->camera_count ? r->wish.camera : scene->default_camera;
    r->camera = scene->cameras[index];
    if (r->wish.moved) EC_TRY(ec_camera_look(&r->wish.viewpoint, scene->center, &r->camera, err));
    ec_view_picture_stop(&r->picture);
    ec_view_others_forget(&r->others);
    double rate = ec_session_rate(r->setup[EC_ROLE_PICTURE]->session), pixels = (double)r->wish.width * r->wish.height;
    double level = rate > 0 ? ceil(sqrt(pixels / (rate * EC_VIEW_FOLLOWS))) : EC_VIEW_COARSEST / 2;
    r->level = (uint32_t)fmin(fmax(level, 1), EC_VIEW_COARSEST);
    r->dirty = false;
    r->aside = true;
    return make_room(r, err);
}

/* Pixel, material and distance under the cursor. */
static void serve_probe(renderer *r, const ec_view_wish *wish)
{
    const ec_scene *scene = r->setup[EC_ROLE_PICTURE]->scene->scene;
    ec_view_probe probe = {.serial = wish->probes, .x = wish->probe_x, .y = wish->probe_y, .material = -1};
    if (probe.x < r->wish.width && probe.y < r->wish.height) {
        ec_view_hit hit = ec_view_pick(scene, &r->camera, r->wish.width, r->wish.height, probe.x, probe.y);
        probe.has_surface = isfinite(hit.distance);
        probe.depth = hit.distance;
        read_pixel(&r->picture.film, &probe);
        if (probe.has_surface) {
            probe.material = scene->triangle_material[hit.triangle];
            const char *name = scene->materials[probe.material].name;
            snprintf(probe.name, sizeof probe.name, "%s", name ? name : "unnamed");
            ec_view_material_sphere(scene, (uint32_t)probe.material, probe.center, &probe.radius);
        }
    }
    pthread_mutex_lock(&r->view->lock);
    r->view->status.probe = probe;
    ec_view_post(r->view);
    pthread_mutex_unlock(&r->view->lock);
}

/* Between waves: is what is being done still wanted? Cursors are answered by the way. */
static bool go_on(void *user)
{
    renderer *r = user;
    ec_view *view = r->view;
    pthread_mutex_lock(&view->lock);
    ec_view_wish wish = view->wish;
    bool other = view->quit || view->incoming[EC_ROLE_PICTURE] || wish.paused || !same_camera(&wish, &r->wish);
    bool asked = wish.probes != view->status.probe.serial;
    pthread_mutex_unlock(&view->lock);
    if (other) return false;
    if (asked) serve_probe(r, &wish);
    return true;
}

/* A picture of a sample a pixel, each for level x level of the window's. While the camera moves it is finished even if the camera has
 * moved on: else there would be none. */
static ec_result preview(renderer *r, ec_error *err)
{
    ec_session *session = r->setup[EC_ROLE_PICTURE]->session;
    uint32_t width = (r->wish.width + r->level - 1) / r->level, height = (r->wish.height + r->level - 1) / r->level;
    ec_session_batch batch = {.seed = ec_session_seed(r->setup[EC_ROLE_PICTURE]->options.seed, 1, r->previews++), .samples = 1,
                              .go_on = r->wish.moving ? NULL : go_on, .user = r, .slice = EC_VIEW_SLICE, .mean = r->mean};
    r->aside = true;
    EC_TRY(look(r, EC_ROLE_PICTURE, width, height, err));
    EC_TRY(ec_session_take(session, &batch, err));
    if (!batch.complete) return EC_OK;
    ec_view_show(r->view, &r->wish, EC_ROLE_PICTURE, r->mean, width, height);
    tell(r, r->level);
    if (!r->wish.moving) r->level = r->level > 3 ? r->level / 2 : 0;
    return EC_OK;
}

static bool is_final(const renderer *r)
{
    return r->setup[EC_ROLE_PICTURE]->options.integrator == r->wish.integrator;
}

static ec_result start_film(renderer *r, ec_error *err)
{
    ec_view_setup *s = r->setup[EC_ROLE_PICTURE];
    return ec_view_picture_start(&r->picture, &s->options, r->wish.more, r->wish.width, r->wish.height, ec_session_rate(s->session), err);
}

static ec_result take_batch(renderer *r, ec_error *err)
{
    bool complete;
    if (!r->picture.film.mean) EC_TRY(start_film(r, err));
    if (r->aside) EC_TRY(look(r, EC_ROLE_PICTURE, r->wish.width, r->wish.height, err));
    r->aside = false;
    EC_TRY(ec_view_picture_take(&r->picture, r->setup[EC_ROLE_PICTURE]->session, go_on, r, r->mean, &complete, err));
    r->dirty |= complete;
    return EC_OK;
}

/* The film as it is now, and what is to stand beside it. */
static void show(renderer *r)
{
    ec_view_wish *wish = &r->wish;
    ec_film_resolve(&r->picture.film, r->mean, NULL);
    bool shown = ec_view_show(r->view, wish, EC_ROLE_PICTURE, r->mean, wish->width, wish->height);
    if (wish->has_second) shown &= ec_view_others_show(&r->others, r->view, wish, &r->picture.film, r->mean);
    if (shown) r->dirty = false;
    tell(r, 0);
}

static void save(renderer *r)
{
    ec_view *view = r->view;
    const ec_view_request *request = view->request;
    ec_view_setup *s = r->setup[EC_ROLE_PICTURE];
    ec_view_picture *p = &r->picture;
    ec_render_stats stats = s->stats;
    ec_render_options options = s->options;
    uint64_t spp = (uint64_t)p->film.batch_count * p->limits.batch;
    char told[2048] = "";
    ec_error err = {0};
    options.width = r->wish.width;
    options.height = r->wish.height;
    options.spp = (uint32_t)spp;
    options.batch = stats.batch = p->limits.batch;
    options.more_effects = view->request->options.more_effects;
    options.error_target = options.time_limit = 0;
    if (!r->wish.moved) options.camera = r->wish.camera;
    stats.seconds = p->seconds;
    stats.samples_per_pixel = spp;
    stats.samples = spp * r->wish.width * r->wish.height;
    stats.samples_per_second = p->seconds > 0 ? (double)stats.samples / p->seconds : 0;
    stats.error = p->error.error;
    stats.error_bound = p->error.error_bound;
    stats.relmse = p->error.relmse;
    stats.invalid_samples = p->invalid;
    snprintf(stats.stopped_by, sizeof stats.stopped_by, "%s", p->stopped_by ? p->stopped_by : "user");
    const ec_view_shot shot = {&p->film, s->scene->scene, &stats, &options, r->wish.moved, r->wish.viewpoint, r->wish.env_degrees,
                               r->wish.exposure, r->wish.tonemap};
    ec_result result = request->save(request->user, &shot, told, sizeof told, &err);
    pthread_mutex_lock(&view->lock);
    snprintf(view->status.told, sizeof view->status.told, "%s", result == EC_OK ? told : err.text);
    view->status.saves_done = r->saves = r->wish.saves;
    ec_view_post(view);
    pthread_mutex_unlock(&view->lock);
}

typedef enum duty { QUIT, WAIT, PREVIEW, SAVE, SECOND, BATCH, SHOW } duty;

static duty choose(const renderer *r)
{
    const ec_view_wish *w = &r->wish;
    if (!r->setup[EC_ROLE_PICTURE] || !w->width || w->paused || r->broken) return WAIT;
    if (r->level) return PREVIEW;
    if (!is_final(r)) return WAIT;
    if (r->dirty) return SHOW;
    if (r->picture.film.batch_count && w->saves != r->saves) return SAVE;
    if (r->picture.film.batch_count && w->has_second && w->second == EC_SECOND_RUNG && r->setup[EC_ROLE_SECOND] && !r->others.rung) return SECOND;
    if (r->picture.stopped_by) return WAIT;
    return BATCH;
}

/* Copies the wish; other cameras, sessions and tones than before mean other work. */
static duty take_wish(renderer *r, ec_error *err)
{
    ec_view *view = r->view;
    ec_view_setup *old[EC_ROLE_COUNT] = {NULL};
    pthread_mutex_lock(&view->lock);
    bool quit = view->quit, swapped = view->incoming[EC_ROLE_PICTURE] != NULL;
    for (int role = 0; role < EC_ROLE_COUNT; role++) {
        if (!view->incoming[role]) continue;
        old[role] = r->setup[role];
        r->setup[role] = view->incoming[role];
        view->incoming[role] = NULL;
        if (role == EC_ROLE_SECOND) ec_view_others_forget(&r->others);
    }
    ec_view_wish wish = view->wish;
    pthread_mutex_unlock(&view->lock);
    for (int role = 0; role < EC_ROLE_COUNT; role++) ec_view_setup_free(view, old[role]);
    if (quit) return QUIT;
    bool afresh = swapped || !same_camera(&wish, &r->wish), rested = r->wish.moving && !wish.moving;
    bool repaint = !same_tones(&wish, &r->wish), more = wish.more != r->wish.more;
    r->wish = wish;
    if (swapped) r->broken = false;
    if (!r->setup[EC_ROLE_PICTURE] || !wish.width) return WAIT;
    if (afresh && start_afresh(r, err) != EC_OK) {
        fail(r, err);
        return WAIT;
    }
    if (rested && r->level > 1) r->level /= 2;
    if (more && r->picture.film.batch_count) ec_view_picture_limit(&r->picture, &r->setup[EC_ROLE_PICTURE]->options, wish.more);
    if (repaint && r->picture.film.batch_count) r->dirty = true;
    else if (repaint && !r->level) r->level = 1;
    if (wish.probes != view->status.probe.serial) serve_probe(r, &wish);
    return choose(r);
}

static ec_result render_rung(renderer *r, ec_error *err)
{
    EC_TRY(look(r, EC_ROLE_SECOND, r->wish.width, r->wish.height, err));
    EC_TRY(ec_view_others_render(&r->others, r->setup[EC_ROLE_SECOND]->session, r->wish.width, r->wish.height, go_on, r, err));
    r->dirty |= r->others.rung != NULL;
    return EC_OK;
}

static ec_result do_duty(renderer *r, duty d, ec_error *err)
{
    if (d == PREVIEW) return preview(r, err);
    if (d == BATCH) return take_batch(r, err);
    if (d == SECOND) return render_rung(r, err);
    if (d == SHOW) show(r);
    if (d == SAVE) save(r);
    return EC_OK;
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
    renderer r = {.view = argument};
    ec_error err = {0};
    uint64_t seen = 0;
    ec_view_others_open(&r.others, r.view->request->against);
    for (duty d; (d = take_wish(&r, &err)) != QUIT;) {
        if (d == WAIT) wait_for_events(r.view, &seen);
        else if (do_duty(&r, d, &err) != EC_OK) fail(&r, &err);
        else if (r.dirty && d == SHOW) wait_for_events(r.view, &seen); /* all slots are on their way */
    }
    for (int role = 0; role < EC_ROLE_COUNT; role++) ec_view_setup_free(r.view, r.setup[role]);
    ec_view_picture_stop(&r.picture);
    ec_view_others_close(&r.others);
    free(r.mean);
    return NULL;
}
