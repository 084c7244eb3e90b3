#include <stdio.h>

#include "view/renderer.h"

static void save(ec_renderer *r, const ec_view_wish *asked)
{
    ec_view *view = r->view;
    const ec_view_request *request = view->request;
    ec_view_setup *s = r->setup[EC_ROLE_PICTURE];
    ec_view_picture *p = &r->picture;
    ec_render_stats stats = s->stats;
    ec_render_options options = s->options;
    const uint64_t spp = ec_view_picture_samples(p);
    char told[2048] = "";
    ec_error err = {0};
    options.width = asked->width;
    options.height = asked->height;
    options.spp = (uint32_t)spp;
    stats.replicates = p->film.replicates;
    options.more_effects = view->request->options.more_effects;
    options.error_target = options.time_limit = 0;
    if (!asked->moved) options.camera = asked->camera;
    stats.seconds = p->seconds;
    stats.samples_per_pixel = spp;
    stats.samples = spp * asked->width * asked->height;
    stats.samples_per_second = p->seconds > 0 ? (double)stats.samples / p->seconds : 0;
    stats.film = p->error;
    stats.invalid_samples = p->invalid;
    snprintf(stats.stopped_by, sizeof stats.stopped_by, "%s", p->stopped_by ? p->stopped_by : "user");
    const ec_view_shot shot = {&p->film, s->scene->scene, &stats, &options, asked->moved, asked->viewpoint, asked->env_degrees,
                               asked->exposure, asked->tonemap};
    ec_result result = request->save(request->user, &shot, told, sizeof told, &err);
    pthread_mutex_lock(&view->lock);
    snprintf(view->status.told, sizeof view->status.told, "%s", result == EC_OK ? told : err.text);
    view->status.saves_done = r->saves = asked->saves;
    *view->status.unsaved = 0;
    ec_view_post(view);
    pthread_mutex_unlock(&view->lock);
}

static void give_up(ec_renderer *r, const ec_view_wish *asked)
{
    ec_view_status *s = &r->view->status;
    pthread_mutex_lock(&r->view->lock);
    snprintf(s->unsaved, sizeof s->unsaved, "not saved: the camera moved before its first samples were there; rest, and save again");
    snprintf(s->told, sizeof s->told, "%s", s->unsaved);
    s->saves_done = r->saves = asked->saves;
    ec_view_post(r->view);
    pthread_mutex_unlock(&r->view->lock);
}

void ec_renderer_serve_save(ec_renderer *r, const ec_view_wish *now, const ec_view_wish *asked)
{
    if (now->saves == r->saves) return;
    if (r->picture.film.batch_count && ec_view_same_camera(asked, &r->wish)) save(r, asked);
    else if (!ec_view_same_camera(asked, now)) give_up(r, asked);
}
