/* What is under the cursor: the film's pixel, and the surface that its centre sees. */
#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "film/pixel.h"
#include "view/renderer.h"

void ec_renderer_read_pixel(const ec_film *film, ec_view_probe *probe)
{
    probe->has_film = film->batch_count > 0 && probe->x < film->width && probe->y < film->height;
    probe->has_error = probe->has_film && film->batch_count > 1;
    if (!probe->has_film) return;
    ec_pixel pixel;
    ec_film_look(film, (uint64_t)probe->y * film->width + probe->x, 1, &pixel);
    for (int c = 0; c < 3; c++) {
        probe->rgb[c] = pixel.mean[c];
        probe->se[c] = sqrt(ec_pixel_se2(&pixel, c));
    }
}

static ec_view_probe look_at(const ec_renderer *r, uint32_t serial, uint32_t x, uint32_t y)
{
    const ec_scene *scene = r->setup[EC_ROLE_PICTURE]->scene->scene;
    ec_view_probe probe = {.serial = serial, .x = x, .y = y, .material = -1, .node = -1};
    probe.is_inside = probe.x < r->wish.width && probe.y < r->wish.height;
    if (probe.is_inside) {
        ec_view_hit hit = ec_view_pick(scene, &r->camera, r->wish.width, r->wish.height, probe.x, probe.y);
        probe.has_surface = isfinite(hit.distance);
        probe.depth = hit.distance;
        ec_renderer_read_pixel(&r->picture.film, &probe);
        if (probe.has_surface) {
            probe.material = scene->triangle_material[hit.triangle];
            const char *name = scene->materials[probe.material].name;
            snprintf(probe.name, sizeof probe.name, "%.*s", EC_CUT(name ? name : "unnamed", sizeof probe.name - 1));
            probe.node = ec_scene_node_of(scene, hit.id);
        }
        if (probe.node >= 0) {
            const char *name = scene->node_names[probe.node] ? scene->node_names[probe.node] : "unnamed";
            snprintf(probe.node_name, sizeof probe.node_name, "%.*s", EC_CUT(name, sizeof probe.node_name - 1));
            ec_view_node_sphere(scene, (uint32_t)probe.node, probe.center, &probe.radius);
        }
    }
    return probe;
}

void ec_renderer_probe(ec_renderer *r, const ec_view_wish *wish)
{
    ec_view_status *s = &r->view->status;
    bool points = wish->probes != s->probe.serial || (r->looked_away && !wish->moving), clicks = wish->clicks != s->clicked.serial;
    ec_view_probe probe, clicked;
    if (!points && !clicks) return;
    if (points) probe = look_at(r, wish->probes, wish->probe_x, wish->probe_y), r->looked_away = false;
    if (clicks) clicked = look_at(r, wish->clicks, wish->click_x, wish->click_y);
    pthread_mutex_lock(&r->view->lock);
    if (points) s->probe = probe;
    if (clicks) s->clicked = clicked;
    ec_view_post(r->view);
    pthread_mutex_unlock(&r->view->lock);
}
