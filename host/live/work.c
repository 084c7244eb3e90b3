/* The renderer's steps: previews of few pixels, batches of the film, the other integrator, and showing them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "film/resolve.h"
#include "live/renderer.h"
#include "pack/called_effects.h"

#define FOLLOWS 0.025 /* seconds for a picture while the camera moves */
#define COARSEST 16u  /* largest side in pixels of the square for a sample */

static void tell(ec_renderer *r, uint32_t preview, bool has_second)
{
    const ec_live_film *p = &r->picture;
    const ec_live_setup *setup = r->setup[ECLAT_PICTURE], *other = r->setup[ECLAT_SECOND_PICTURE];
    pthread_mutex_lock(&r->live->lock);
    eclat_status *s = &r->live->status;
    s->preview = preview;
    s->integrator = (eclat_integrator)setup->options.integrator;
    s->samples = (uint64_t)ec_film_samples_of_all(&p->film);
    s->seconds = p->seconds;
    s->error = p->film.batch_count ? p->error.error : INFINITY;
    s->error_bound = p->film.batch_count ? p->error.error_bound : INFINITY;
    s->is_denoised = !preview && p->film.clean.best != NULL;
    s->best = (eclat_stated_error){p->denoised.best.error, p->denoised.best.low95, p->denoised.best.high95};
    snprintf(s->undenoised, sizeof s->undenoised, "%s", p->undenoised);
    s->seconds_left = p->goal.forecast.pilot_samples ? fmax(p->goal.forecast.seconds - p->seconds, 0) : -1;
    s->spp_limit = p->limits.spp;
    s->time_limit = p->limits.time_limit;
    s->error_limit = p->limits.error_target;
    if (!preview || s->second != ECLAT_SECOND_FILE) s->second = has_second ? r->view.second : ECLAT_SECOND_NONE; /* a file does not depend on the camera */
    if (other) s->second_integrator = (eclat_integrator)other->options.integrator;
    s->is_complete = p->film.batch_count && p->stopped_by;
    ec_renderer_read_pixel(&p->film, &s->under);
    snprintf(s->stopped_by, sizeof s->stopped_by, "%s", p->stopped_by ? p->stopped_by : "");
    ec_feature_names(setup->stats.effects.called.bits, s->effects, sizeof s->effects);
    ec_live_tell(r->live);
    pthread_mutex_unlock(&r->live->lock);
}

/* Sets a session's view to this many pixels. */
static ec_result look(ec_renderer *r, eclat_shown which, uint32_t width, uint32_t height, ec_error *err)
{
    const ec_session_view look = {r->camera, width, height, r->view.env_degrees};
    return ec_session_look(r->setup[which]->session, &look, err);
}

static ec_result make_room(ec_renderer *r, ec_error *err)
{
    uint64_t pixels = (uint64_t)r->view.width * r->view.height;
    if (r->room >= pixels) return EC_OK;
    free(r->mean);
    r->room = 0;
    r->mean = malloc(pixels * 3 * sizeof(float));
    if (!r->mean) return ec_fail(err, "out of memory for a picture of %ux%u pixels", r->view.width, r->view.height);
    r->room = pixels;
    return EC_OK;
}

ec_result ec_renderer_start_afresh(ec_renderer *r, ec_error *err)
{
    ec_live_film_stop(&r->picture);
    ec_live_second_forget(&r->second);
    const ec_live_setup *setup = r->setup[ECLAT_PICTURE];
    const ec_scene *scene = setup->scene->job.scene;
    const ec_viewpoint viewpoint = ec_live_viewpoint(&r->view);
    r->camera = scene->cameras[ec_live_camera(setup->scene, &r->view)];
    if (r->view.is_moved) EC_TRY(ec_camera_look(&viewpoint, scene->center, &r->camera, err));
    r->looked_away = true;
    double rate = ec_session_rate(setup->session), pixels = (double)r->view.width * r->view.height;
    double level = rate > 0 ? ceil(sqrt(pixels / (rate * FOLLOWS))) : COARSEST / 2;
    r->level = (uint32_t)fmin(fmax(level, 1), COARSEST);
    r->dirty = false;
    r->aside = true;
    return make_room(r, err);
}

/* Called between waves: tells whether the current work is still wanted, and answers probes and saves. */
static bool go_on(void *user)
{
    ec_renderer *r = user;
    ec_live *live = r->live;
    pthread_mutex_lock(&live->lock);
    const ec_live_asked asked = live->asked;
    bool other = live->quit || live->incoming[ECLAT_PICTURE] || asked.view.is_paused || !ec_live_same_camera(&asked.view, &r->view);
    pthread_mutex_unlock(&live->lock);
    if (r->picture.film.batch_count) ec_renderer_serve_save(r, &asked);
    if (other) return false;
    ec_renderer_probe(r, &asked);
    return true;
}

/* Takes a preview with one sample for each level x level pixels. While the camera moves it is completed even if the camera has moved on; otherwise
 * there would be no pictures. */
ec_result ec_renderer_preview(ec_renderer *r, ec_error *err)
{
    const ec_live_setup *setup = r->setup[ECLAT_PICTURE];
    uint32_t width = (r->view.width + r->level - 1) / r->level, height = (r->view.height + r->level - 1) / r->level;
    ec_session_batch batch = {.seed = ec_session_seed(setup->options.seed, 1, r->previews++), .samples = 1,
                              .go_on = r->view.is_moving ? NULL : go_on, .user = r, .slice = EC_LIVE_SLICE, .rgb = r->mean};
    r->aside = true;
    EC_TRY(look(r, ECLAT_PICTURE, width, height, err));
    EC_TRY(ec_session_take(setup->session, &batch, err));
    if (!batch.complete) return EC_OK;
    EC_TRY(ec_live_show(r->live, &r->view, ECLAT_PICTURE, r->mean, width, height, err));
    tell(r, r->level, false);
    if (!r->view.is_moving) r->level = r->level > 3 ? r->level / 2 : 0;
    return EC_OK;
}

ec_result ec_renderer_take_batch(ec_renderer *r, ec_error *err)
{
    const ec_live_setup *setup = r->setup[ECLAT_PICTURE];
    bool complete;
    ec_render_options options = setup->options;
    if (!r->view.is_denoised || !ec_traces_paths(options.integrator)) options.denoise = EC_DENOISER_NONE;
    else if (!options.denoise) options.denoise = EC_DENOISER_AUTO;
    if (!r->picture.film.width) EC_TRY(ec_live_film_start(&r->picture, &options, r->view.more, r->view.width, r->view.height, err));
    if (r->aside) EC_TRY(look(r, ECLAT_PICTURE, r->view.width, r->view.height, err));
    r->aside = false;
    EC_TRY(ec_live_film_take(&r->picture, setup->session, go_on, r, &complete, err));
    r->dirty |= complete;
    return EC_OK;
}

ec_result ec_renderer_take_second(ec_renderer *r, ec_error *err)
{
    EC_TRY(look(r, ECLAT_SECOND_PICTURE, r->view.width, r->view.height, err));
    EC_TRY(ec_live_second_render(&r->second, r->setup[ECLAT_SECOND_PICTURE]->session, r->view.width, r->view.height, go_on, r, err));
    r->dirty |= r->second.other != NULL;
    return EC_OK;
}

/* Shows the film as it is now, and the second picture. */
ec_result ec_renderer_show(ec_renderer *r, ec_error *err)
{
    const eclat_view_request *view = &r->view;
    const ec_film *film = &r->picture.film;
    bool has_second;
    r->dirty = false;
    ec_film_resolve(film, r->mean, NULL);
    if (r->picture.limits.denoise && !view->is_moving) ec_live_film_clean(&r->picture, &r->live->device, false);
    EC_TRY(ec_live_show(r->live, view, ECLAT_PICTURE, film->clean.best ? film->clean.best : r->mean, view->width, view->height, err));
    EC_TRY(ec_live_second_show(&r->second, r->live, view, film, r->mean, &has_second, err));
    tell(r, 0, has_second);
    return EC_OK;
}
