/* Reads a pixel of the film, and finds the surface that the pixel's centre sees. */
#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "film/pixel.h"
#include "live/renderer.h"

void ec_renderer_read_pixel(const ec_film *film, eclat_probe *probe)
{
    probe->has_value = film->batch_count > 0 && probe->x < film->width && probe->y < film->height;
    probe->has_error = probe->has_value && film->batch_count > 1;
    if (!probe->has_value) return;
    ec_pixel pixel;
    ec_film_look(film, (uint64_t)probe->y * film->width + probe->x, 1, &pixel);
    for (int c = 0; c < 3; c++) {
        probe->rgb[c] = pixel.mean[c];
        probe->se[c] = sqrt(ec_pixel_se2(&pixel, c));
    }
}

static void copy_name(char to[100], const char *name) { snprintf(to, 100, "%.*s", EC_CUT(name ? name : "unnamed", 99)); }

static eclat_probe look_at(const ec_renderer *r, uint32_t x, uint32_t y)
{
    const ec_scene *scene = r->setup[ECLAT_PICTURE]->scene->job.scene;
    eclat_probe probe = {.x = x, .y = y, .is_inside = x < r->view.width && y < r->view.height, .material = -1, .node = -1};
    if (!probe.is_inside) return probe;
    ec_render_options options = r->setup[ECLAT_PICTURE]->options;
    options.width = r->view.width, options.height = r->view.height;
    ec_live_hit hit = ec_live_pick(scene, &r->camera, &options, x, y);
    probe.has_surface = isfinite(hit.distance);
    probe.depth = hit.distance;
    ec_renderer_read_pixel(&r->picture.film, &probe);
    if (!probe.has_surface) return probe;
    probe.material = scene->triangle_material[hit.triangle];
    copy_name(probe.material_name, scene->materials[probe.material].name);
    probe.node = ec_scene_node_of(scene, hit.id);
    if (probe.node < 0) return probe;
    copy_name(probe.node_name, scene->node_names[probe.node]);
    ec_live_node_sphere(scene, (uint32_t)probe.node, probe.center, &probe.radius);
    return probe;
}

void ec_renderer_probe(ec_renderer *r, const ec_live_asked *asked)
{
    eclat_status *s = &r->live->status;
    const eclat_view_request *view = &asked->view;
    bool is_elsewhere = view->x != s->under.x || view->y != s->under.y;
    bool points = is_elsewhere || (r->looked_away && !view->is_moving), picks = asked->picks != s->picks;
    eclat_probe under, picked;
    if (!points && !picks) return;
    if (points) under = look_at(r, view->x, view->y), r->looked_away = false;
    if (picks) picked = look_at(r, asked->pick_x, asked->pick_y);
    pthread_mutex_lock(&r->live->lock);
    if (points) s->under = under;
    if (picks) s->picked = picked, s->picks = asked->picks;
    ec_live_tell(r->live);
    pthread_mutex_unlock(&r->live->lock);
}
