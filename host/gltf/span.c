/* Measures a scene over the course of an animation: what stands still is measured once, what may move at equal time steps. */
#include <math.h>
#include <stdlib.h>

#include "gltf/flatten_vertex.h"
#include "gltf/span.h"

static void span_mesh(const ec_gltf *g, const ec_placement *at, double low[3], double high[3])
{
    static const double middle[3] = {0};
    ec_draw d = ec_draw_of(g, at, middle);
    for (uint32_t k = 0; k < g->meshes[at->mesh].primitive_count; k++) {
        d.p = &g->meshes[at->mesh].primitives[k];
        if (d.p->drawn) ec_draw_span(&d, low, high);
    }
}

static ec_result place(ec_gltf *g, ec_placement_list *placements, ec_error *err)
{
    ec_scene counted = {0};
    EC_TRY(ec_gltf_place_nodes(g, placements, err));
    EC_TRY(ec_gltf_place_instances(g, placements, NULL, err));
    EC_TRY(ec_flatten_prepare(g, placements, &counted, NULL, err));
    return ec_gltf_deform(g, placements, err);
}

static ec_result look(ec_gltf *g, const ec_scene_choice *choice, bool first, double low[3], double high[3], ec_error *err)
{
    ec_placement_list placements = {0};
    EC_TRY(ec_gltf_pose(g, choice, false, NULL, err));
    const ec_result result = place(g, &placements, err);
    for (uint32_t i = 0; result == EC_OK && i < placements.count; i++)
        if (placements.items[i].mesh >= 0 && (first || placements.items[i].reached)) span_mesh(g, &placements.items[i], low, high);
    free(placements.items);
    return result;
}

ec_result ec_gltf_span(ec_gltf *g, const ec_scene_choice *choice, double seconds, double low[3], double high[3], ec_error *err)
{
    ec_scene_choice moment = *choice;
    for (int k = 0; k < 3; k++) low[k] = INFINITY, high[k] = -INFINITY;
    for (uint32_t i = 0; i <= EC_SPAN_STEPS; i++) {
        moment.at = seconds * i / EC_SPAN_STEPS;
        EC_TRY(look(g, &moment, i == 0, low, high, err));
    }
    return EC_OK;
}
