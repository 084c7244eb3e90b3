#include <stdio.h>

#include "view/renderer.h"

void ec_renderer_save(ec_renderer *r)
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
