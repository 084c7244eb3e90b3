/* A scene with effects switched off: what --without and `eclat cost` render. */
#include <string.h>

#include "pack/texture_fold.h"
#include "pack/pack.h"

const uint64_t ec_effects_optional =
    EC_FEATURE_EMISSION | EC_FEATURE_PUNCTUAL_LIGHTS | EC_FEATURE_ENVIRONMENT | EC_FEATURE_SPECULAR | EC_FEATURE_SMOOTH_NORMALS |
    EC_FEATURE_VERTEX_COLORS | EC_FEATURE_BASE_COLOR_TEXTURE | EC_FEATURE_METALLIC_ROUGHNESS_TEXTURE | EC_FEATURE_NORMAL_TEXTURE |
    EC_FEATURE_EMISSION_TEXTURE | EC_FEATURE_SPECULAR_TEXTURE | EC_FEATURE_ALPHA | EC_FEATURE_TRANSMISSION |
    EC_FEATURE_TRANSMISSION_TEXTURE | EC_FEATURE_ABSORPTION | EC_FEATURE_CLEARCOAT | EC_FEATURE_CLEARCOAT_TEXTURE |
    EC_FEATURE_CLEARCOAT_NORMAL_TEXTURE | EC_FEATURE_SHEEN | EC_FEATURE_SHEEN_TEXTURE | EC_FEATURE_ANISOTROPY |
    EC_FEATURE_ANISOTROPY_TEXTURE | EC_FEATURE_IRIDESCENCE | EC_FEATURE_IRIDESCENCE_TEXTURE | EC_FEATURE_DIFFUSE_TRANSMISSION |
    EC_FEATURE_DIFFUSE_TRANSMISSION_TEXTURE | EC_FEATURE_DISPERSION | EC_FEATURE_ENVIRONMENT_MAP | EC_FEATURE_ENVIRONMENT_TURN |
    EC_FEATURE_CULLING | EC_FEATURE_UNLIT | EC_FEATURE_PANES | EC_FEATURE_NESTED | EC_FEATURE_MOTION;

/* Textures by their means: slots that an effect reads. */
static const struct {
    uint64_t effect;
    int slot;
} textured[] = {
    {EC_FEATURE_BASE_COLOR_TEXTURE, EC_SLOT_BASE_COLOR},
    {EC_FEATURE_METALLIC_ROUGHNESS_TEXTURE, EC_SLOT_METALLIC_ROUGHNESS},
    {EC_FEATURE_NORMAL_TEXTURE, EC_SLOT_NORMAL},
    {EC_FEATURE_EMISSION_TEXTURE, EC_SLOT_EMISSION},
    {EC_FEATURE_SPECULAR_TEXTURE, EC_SLOT_SPECULAR},
    {EC_FEATURE_SPECULAR_TEXTURE, EC_SLOT_SPECULAR_COLOR},
    {EC_FEATURE_TRANSMISSION_TEXTURE, EC_SLOT_TRANSMISSION},
    {EC_FEATURE_CLEARCOAT_TEXTURE, EC_SLOT_CLEARCOAT},
    {EC_FEATURE_CLEARCOAT_TEXTURE, EC_SLOT_CLEARCOAT_ROUGHNESS},
    {EC_FEATURE_CLEARCOAT_NORMAL_TEXTURE, EC_SLOT_CLEARCOAT_NORMAL},
    {EC_FEATURE_SHEEN_TEXTURE, EC_SLOT_SHEEN_COLOR},
    {EC_FEATURE_SHEEN_TEXTURE, EC_SLOT_SHEEN_ROUGHNESS},
    {EC_FEATURE_ANISOTROPY_TEXTURE, EC_SLOT_ANISOTROPY},
    {EC_FEATURE_IRIDESCENCE_TEXTURE, EC_SLOT_IRIDESCENCE},
    {EC_FEATURE_IRIDESCENCE_TEXTURE, EC_SLOT_IRIDESCENCE_THICKNESS},
    {EC_FEATURE_DIFFUSE_TRANSMISSION_TEXTURE, EC_SLOT_DIFFUSE_TRANSMISSION},
    {EC_FEATURE_DIFFUSE_TRANSMISSION_TEXTURE, EC_SLOT_DIFFUSE_TRANSMISSION_COLOR},
};

/* Coverage is no colour: it stays. */
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
    for (size_t i = 0; i < sizeof textured / sizeof *textured; i++) {
        if (!(off & textured[i].effect)) continue;
        bool covers = textured[i].slot == EC_SLOT_BASE_COLOR && m->alpha_mode != EC_ALPHA_OPAQUE;
        if (covers) EC_TRY(without_color(scene, view, m, err));
        else ec_texture_flatten(scene, m, textured[i].slot);
    }
    if (off & EC_FEATURE_CULLING) m->double_sided = true;
    if (off & EC_FEATURE_UNLIT) m->unlit = false;
    if (off & EC_FEATURE_EMISSION) memset(m->emission, 0, sizeof m->emission);
    if (off & EC_FEATURE_SPECULAR) m->metallic = m->specular = 0.0f;
    if (off & EC_FEATURE_TRANSMISSION) m->transmission = 0.0f;
    if (off & EC_FEATURE_ABSORPTION) memset(m->absorption, 0, sizeof m->absorption);
    if (off & EC_FEATURE_CLEARCOAT) m->coat = 0.0f;
    if (off & EC_FEATURE_SHEEN) memset(m->sheen, 0, sizeof m->sheen);
    if (off & EC_FEATURE_ANISOTROPY) m->anisotropy = 0.0f;
    if (off & EC_FEATURE_IRIDESCENCE) m->film = 0.0f;
    if (off & EC_FEATURE_DIFFUSE_TRANSMISSION) m->diffuse_transmission = 0.0f;
    if (off & EC_FEATURE_DISPERSION) m->dispersion = 0.0f;
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
