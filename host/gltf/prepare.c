/* Checks every primitive that is placed, once, before anything is allocated for it. */
#include "base/text.h"
#include "gltf/flatten.h"

#include <stdio.h>

typedef struct tally {
    uint32_t no_positions, left_over;
} tally;

static ec_result prepare_mesh(ec_gltf *g, int32_t index, tally *skipped, ec_error *err)
{
    ec_gltf_mesh *mesh = &g->meshes[index];
    for (uint32_t k = 0; k < mesh->primitive_count; k++) {
        ec_gltf_primitive *p = &mesh->primitives[k];
        char where[192];
        if (mesh->name) snprintf(where, sizeof where, "meshes[%d] \"%.*s\" primitives[%u]", index, EC_CUT(mesh->name, 80), k);
        else snprintf(where, sizeof where, "meshes[%d].primitives[%u]", index, k);
        EC_TRY(ec_gltf_primitive_prepare(g, p, where, err));
        if (p->streams.of[EC_POSITION] < 0) skipped->no_positions++;
        else if (p->left_over) skipped->left_over++;
    }
    return EC_OK;
}

ec_result ec_flatten_prepare(ec_gltf *g, const ec_placement_list *placements, ec_scene *scene, const ec_log *log,
                             ec_error *err)
{
    tally skipped = {0};
    for (uint32_t i = 0; i < placements->count; i++) {
        int32_t mesh = placements->items[i].mesh;
        if (mesh < 0) continue;
        scene->instance_count++;
        EC_TRY(prepare_mesh(g, mesh, &skipped, err));
    }
    if (skipped.no_positions)
        ec_warn(log, "%s: %u primitives without POSITION are left out", g->path, skipped.no_positions);
    if (skipped.left_over)
        ec_warn(log, "%s: %u primitives have leftover vertices, too few for a triangle; these are left out", g->path, skipped.left_over);
    scene->skipped_primitives = skipped.no_positions;
    return EC_OK;
}
