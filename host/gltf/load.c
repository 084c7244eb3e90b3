/* Makes a scene of a glTF document, step by step. */
#include "gltf/flatten.h"
#include "gltf/thicken.h"
#include "scene/validate.h"
#include "gltf/reader.h"

#include <math.h>
#include <stdlib.h>

/* Moves the counts and names into the scene, which then owns the strings. */
static void take_facts(ec_gltf *g, ec_scene *s)
{
    s->mesh_count = g->mesh_count;
    s->node_count = g->node_count;
    s->contents = g->contents;
    g->contents = (ec_scene_contents){0}; /* only the first scene of an animation has them */
}

static ec_result build(const ec_scene_choice *choice, ec_gltf *g, ec_placement_list *placements, ec_scene *s,
                       const ec_log *log, ec_error *err)
{
    take_facts(g, s);
    EC_TRY(ec_flatten_prepare(g, placements, s, log, err));
    EC_TRY(ec_gltf_deform(g, placements, err));
    EC_TRY(ec_gltf_thicken(g, placements, false, err));
    EC_TRY(ec_gltf_materials_assign(g, s, log, err));
    EC_TRY(ec_gltf_textures_load(g, placements, s, log, err));
    EC_TRY(ec_gltf_hide(g, placements, s, log, err));
    EC_TRY(ec_flatten(g, placements, s, log, err));
    EC_TRY(ec_gltf_cameras_place(g, placements, s, log, err));
    EC_TRY(ec_gltf_lights_place(g, placements, s, log, err));
    EC_TRY(ec_gltf_image_light_load(g, s, log, err));
    if (g->blurs) EC_TRY(ec_gltf_move(choice, g, s, log, err));
    for (uint32_t i = 0; g->frame && i < placements->count; i++)
        s->whole |= placements->items[i].reached && placements->items[i].mesh >= 0;
    ec_scene_clamp_materials(s, g->path, log);
    EC_TRY(ec_scene_validate(s, err));
    ec_scene_join_quads(s);
    return EC_OK;
}

ec_result ec_scene_from_gltf(const ec_scene_choice *choice, ec_gltf *gltf, ec_scene **scene, const ec_log *log, ec_error *err)
{
    ec_result result = EC_FAILED;
    ec_placement_list placements = {0};
    ec_scene *s = calloc(1, sizeof *s);
    *scene = NULL;
    if (!s) return ec_fail(err, "%s: out of memory", gltf->path);
    EC_TRY_CLEANUP(ec_gltf_place_nodes(gltf, &placements, err));
    EC_TRY_CLEANUP(ec_gltf_place_instances(gltf, &placements, log, err));
    EC_TRY_CLEANUP(build(choice, gltf, &placements, s, log, err));
    *scene = s;
    s = NULL;
cleanup:
    free(placements.items);
    ec_scene_free(s);
    return result;
}

ec_result ec_settle_moment(const char *path, const ec_scene_choice *choice, ec_scene_choice *moment, ec_error *err)
{
    *moment = *choice;
    if (!choice->shutter) return EC_OK;
    if (!(isfinite(choice->opens) && choice->opens <= choice->closes && isfinite(choice->closes)))
        return ec_fail(err, "%s: a shutter cannot open at %g s and close at %g s", path, choice->opens, choice->closes);
    moment->animated = true;
    moment->at = 0.5 * (choice->opens + choice->closes);
    moment->shutter = choice->opens < choice->closes;
    return EC_OK;
}

ec_result ec_scene_load_choice(const char *path, const ec_scene_choice *choice, ec_scene **scene, const ec_log *log, ec_error *err)
{
    ec_gltf *gltf = NULL;
    ec_scene_choice moment;
    *scene = NULL;
    EC_TRY(ec_settle_moment(path, choice, &moment, err));
    ec_result result = ec_gltf_read(path, &moment, &gltf, log, err);
    if (gltf) gltf->instancing = choice->instancing;
    if (result == EC_OK) result = ec_scene_from_gltf(&moment, gltf, scene, log, err);
    ec_gltf_free(gltf);
    return result;
}

ec_result ec_scene_load(const char *path, ec_scene **scene, const ec_log *log, ec_error *err)
{
    return ec_scene_load_choice(path, &(ec_scene_choice){0}, scene, log, err);
}
