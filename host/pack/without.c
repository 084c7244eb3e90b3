/* Makes a scene with effects switched off, for --without and `eclat cost`. */
#include "pack/pack.h"
#include "pack/texture_fold.h"
#include "scene/material_fields.h"

#define WEIGHED(field, floats, value, least, most, slot, channel, effect, has, path) | EC_FEATURE_##effect
#define TEXTURED(name, is_srgb, effect, textured, has, path) | EC_FEATURE_##textured
#define NOTHING(...)
const uint64_t ec_effects_optional =
    EC_FEATURE_PUNCTUAL_LIGHTS | EC_FEATURE_ENVIRONMENT | EC_FEATURE_SMOOTH_NORMALS | EC_FEATURE_VERTEX_COLORS | EC_FEATURE_ALPHA |
    EC_FEATURE_ENVIRONMENT_MAP | EC_FEATURE_ENVIRONMENT_TURN | EC_FEATURE_CULLING | EC_FEATURE_UNLIT | EC_FEATURE_PANES |
    EC_FEATURE_NESTED | EC_FEATURE_MOTION EC_MATERIAL_FIELDS(WEIGHED, WEIGHED, NOTHING, NOTHING) EC_SLOTS(TEXTURED);

/* Replaces the base colour's texture, but keeps coverage, which is not a colour. */
static ec_result without_color(const ec_scene *scene, ec_scene_view *view, ec_material *m, ec_error *err)
{
    ec_texture_use *use = &m->textures[EC_SLOT_BASE_COLOR];
    if (use->texture < 0) return EC_OK;
    ec_texture_flatten_color(scene, m, EC_SLOT_BASE_COLOR);
    return ec_scene_view_whiten(view, &use->texture, err);
}

static ec_result without(const ec_scene *scene, uint64_t off, ec_scene_view *view, ec_material *m, ec_error *err)
{
    if (off & EC_FEATURE_ALPHA) m->alpha_mode = EC_ALPHA_OPAQUE;
    for (int slot = 0; slot < EC_SLOT_COUNT; slot++) { /* replaced by their means */
        if (!(off & ec_material_slots[slot].textured)) continue;
        bool covers = slot == EC_SLOT_BASE_COLOR && m->alpha_mode != EC_ALPHA_OPAQUE;
        if (covers) EC_TRY(without_color(scene, view, m, err));
        else ec_texture_flatten(scene, m, slot);
    }
    if (off & EC_FEATURE_CULLING) m->double_sided = true;
    if (off & EC_FEATURE_UNLIT) m->unlit = false;
    ec_material_clear(m, off);
    return EC_OK;
}

ec_result ec_scene_view_without(const ec_scene *scene, uint64_t off, int64_t material, ec_scene_view *view, ec_error *err)
{
    EC_TRY(ec_scene_view_make(scene, view, err));
    ec_scene *s = &view->scene;
    for (uint32_t m = 0; m < s->material_count; m++) {
        if (material != EC_ALL_MATERIALS && material != m) continue;
        if (without(scene, off, view, &s->materials[m], err) == EC_OK) continue;
        ec_scene_view_free(view);
        return EC_FAILED;
    }
    if (off & EC_FEATURE_MOTION) s->motion = (ec_motion){0};
    if (off & EC_FEATURE_PUNCTUAL_LIGHTS) s->light_count = 0;
    if (off & EC_FEATURE_SMOOTH_NORMALS) s->normals = NULL;
    if (off & EC_FEATURE_VERTEX_COLORS) s->colors = NULL;
    if (off & EC_FEATURE_PANES) s->solid_shadows = true;
    if (off & EC_FEATURE_NESTED) s->bodies_apart = true;
    if (off & EC_FEATURE_ENVIRONMENT_TURN) s->environment.turned = false;
    if ((off & EC_FEATURE_ENVIRONMENT_MAP) && s->environment.rgb) {
        float mean[3];
        ec_environment_mean(&scene->environment, mean);
        s->environment = (ec_environment){.constant = {mean[0], mean[1], mean[2]}};
    }
    if (off & EC_FEATURE_ENVIRONMENT) {
        s->has_environment = false;
        s->environment = (ec_environment){0};
    }
    return EC_OK;
}

ec_result ec_scene_calls(const ec_scene *scene, ec_effects *effects, ec_error *err)
{
    ec_scene_view plain;
    ec_bodies bodies;
    EC_TRY(ec_scene_view_plain(scene, &plain, err));
    ec_result result = ec_pack_find_bodies(&plain.scene, &bodies, err);
    if (result == EC_OK) result = ec_pack_effects(&plain.scene, &bodies, effects, err);
    ec_scene_view_free(&plain);
    return result;
}

ec_result ec_scene_rough(const ec_scene *scene, ec_effects *effects, ec_error *err)
{
    ec_scene_view plain;
    EC_TRY(ec_scene_view_plain(scene, &plain, err));
    *effects = (ec_effects){0};
    ec_pack_rough(&plain.scene, effects);
    ec_scene_view_free(&plain);
    return EC_OK;
}
