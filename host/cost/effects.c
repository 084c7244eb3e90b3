#include "cost/effects.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pack/pack.h"
#include "pack/texture_mean.h"

static bool is_positive(const float v[3]) { return v[0] > 0 || v[1] > 0 || v[2] > 0; }

/* Coverage comes from the base colour's texture: there it stays. */
static bool has_flat_color(const ec_material *m) { return m->textures[EC_SLOT_BASE_COLOR].texture < 0 || m->alpha_mode != EC_ALPHA_OPAQUE; }

static bool is_other_slot(int slot) { return slot != EC_SLOT_BASE_COLOR && slot != EC_SLOT_NORMAL && slot != EC_SLOT_EMISSION; }

static bool material_has(const ec_material *m, ec_cost_effect_kind kind)
{
    switch (kind) {
    case EC_EFFECT_BASE_TEXTURES: return !has_flat_color(m);
    case EC_EFFECT_NORMAL_MAPS: return m->textures[EC_SLOT_NORMAL].texture >= 0 && !m->unlit;
    case EC_EFFECT_GLOSS: return !m->unlit && (m->metallic > 0 || (m->specular > 0 && is_positive(m->specular_color)));
    case EC_EFFECT_TRANSMISSION: return !m->unlit && m->transmission > 0;
    case EC_EFFECT_ALPHA: return m->alpha_mode != EC_ALPHA_OPAQUE;
    case EC_EFFECT_LAMPS: return !m->unlit && is_positive(m->emission);
    case EC_EFFECT_OTHER_TEXTURES:
        for (int k = 0; k < EC_SLOT_COUNT; k++)
            if (is_other_slot(k) && m->textures[k].texture >= 0 && !m->unlit) return true;
        return false;
    default: return false;
    }
}

/* Only materials that some triangle shows count. */
static bool is_shown(const ec_scene *scene, uint32_t material)
{
    for (uint32_t t = 0; t < scene->triangle_count; t++)
        if (scene->triangle_material[t] == material) return true;
    return false;
}

static bool has_smooth_normals(const ec_scene *scene)
{
    ec_effects effects;
    ec_pack_effects(scene, &effects);
    return effects.bits & EC_FEATURE_SMOOTH_NORMALS;
}

bool ec_cost_has_effect(const ec_scene *scene, ec_cost_effect effect)
{
    switch (effect.kind) {
    case EC_EFFECT_NONE: return false;
    case EC_EFFECT_INDIRECT: return true;
    case EC_EFFECT_ENVIRONMENT: return scene->has_environment;
    case EC_EFFECT_PUNCTUAL: return scene->light_count > 0;
    case EC_EFFECT_SMOOTH_NORMALS: return has_smooth_normals(scene);
    case EC_EFFECT_LAMPS:
        return material_has(&scene->materials[effect.material], effect.kind) && is_shown(scene, effect.material);
    default: break;
    }
    for (uint32_t m = 0; m < scene->material_count; m++)
        if (material_has(&scene->materials[m], effect.kind) && is_shown(scene, m)) return true;
    return false;
}

/* Of a channel of a texture that holds numbers. */
static float mean_of_channel(const ec_scene *scene, const ec_texture_use *use, int channel)
{
    const ec_image *image = &scene->images[scene->textures[use->texture].image];
    size_t count = (size_t)image->width * image->height;
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += image->rgba16 ? image->rgba16[4 * i + channel] / 65535.0 : image->rgba8[4 * i + channel] / 255.0;
    return count ? (float)(sum / (double)count) : 1.0f;
}

static void flatten_base(const ec_scene *scene, ec_material *m)
{
    ec_texture_mean mean = ec_texture_whole_mean(scene, &m->textures[EC_SLOT_BASE_COLOR]);
    for (int k = 0; k < 3; k++) m->base_color[k] *= (float)mean.rgb[k];
    m->textures[EC_SLOT_BASE_COLOR].texture = -1;
}

static void flatten_others(const ec_scene *scene, ec_material *m)
{
    const ec_texture_use *use = m->textures;
    if (use[EC_SLOT_METALLIC_ROUGHNESS].texture >= 0) {
        m->roughness *= mean_of_channel(scene, &use[EC_SLOT_METALLIC_ROUGHNESS], 1);
        m->metallic *= mean_of_channel(scene, &use[EC_SLOT_METALLIC_ROUGHNESS], 2);
    }
    if (use[EC_SLOT_SPECULAR].texture >= 0) m->specular *= mean_of_channel(scene, &use[EC_SLOT_SPECULAR], 3);
    if (use[EC_SLOT_TRANSMISSION].texture >= 0) m->transmission *= mean_of_channel(scene, &use[EC_SLOT_TRANSMISSION], 0);
    if (use[EC_SLOT_SPECULAR_COLOR].texture >= 0) {
        ec_texture_mean mean = ec_texture_whole_mean(scene, &use[EC_SLOT_SPECULAR_COLOR]);
        for (int k = 0; k < 3; k++) m->specular_color[k] *= (float)mean.rgb[k];
    }
    for (int k = 0; k < EC_SLOT_COUNT; k++)
        if (is_other_slot(k)) m->textures[k].texture = -1;
}

static void edit_material(const ec_scene *scene, ec_cost_effect_kind kind, ec_material *m)
{
    if (kind == EC_EFFECT_BASE_TEXTURES) flatten_base(scene, m);
    if (kind == EC_EFFECT_NORMAL_MAPS) m->textures[EC_SLOT_NORMAL].texture = -1;
    if (kind == EC_EFFECT_OTHER_TEXTURES) flatten_others(scene, m);
    if (kind == EC_EFFECT_GLOSS) m->metallic = m->specular = 0;
    if (kind == EC_EFFECT_TRANSMISSION) m->transmission = 0;
    if (kind == EC_EFFECT_ALPHA) m->alpha_mode = EC_ALPHA_OPAQUE;
    if (kind == EC_EFFECT_LAMPS) memset(m->emission, 0, sizeof m->emission);
}

ec_result ec_cost_without(const ec_scene *scene, ec_cost_effect effect, ec_cost_edit *edit, ec_error *err)
{
    *edit = (ec_cost_edit){.scene = *scene};
    if (effect.kind == EC_EFFECT_ENVIRONMENT) {
        edit->scene.has_environment = false;
        edit->scene.environment = (ec_environment){0};
    }
    if (effect.kind == EC_EFFECT_PUNCTUAL) edit->scene.light_count = 0;
    if (effect.kind == EC_EFFECT_SMOOTH_NORMALS) edit->scene.normals = NULL;
    if (effect.kind < EC_EFFECT_BASE_TEXTURES) return EC_OK;
    edit->materials = malloc(scene->material_count * sizeof *edit->materials);
    if (!edit->materials) return ec_fail(err, "out of memory for %u materials", scene->material_count);
    memcpy(edit->materials, scene->materials, scene->material_count * sizeof *edit->materials);
    for (uint32_t m = 0; m < scene->material_count; m++)
        if (material_has(&scene->materials[m], effect.kind) && (effect.kind != EC_EFFECT_LAMPS || m == effect.material))
            edit_material(scene, effect.kind, &edit->materials[m]);
    edit->scene.materials = edit->materials;
    return EC_OK;
}

void ec_cost_restore(ec_cost_edit *edit)
{
    free(edit->materials);
    *edit = (ec_cost_edit){0};
}
