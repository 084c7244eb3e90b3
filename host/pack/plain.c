/* Removes whatever has no effect on the picture before the scan, so that a specialised build and a full one read the same numbers. */
#include <math.h>
#include <string.h>

#include "base/freed.h"
#include "pack/texture_fold.h"
#include "pack/pack.h"
#include "scene/material_fields.h"
#include "scene/texture_range.h"

/* Facts about the triangles of a material. */
typedef struct shown {
    bool any;
    float least_alpha, most_alpha; /* of vertex colours; 1 without these */
} shown;

static bool is_zero(const float v[3]) { return v[0] == 0.0f && v[1] == 0.0f && v[2] == 0.0f; }

static void drop(ec_material *m, int slot) { m->textures[slot].texture = -1; }

/* Clears transmission that has no effect: through metal, or where the texture is 0. */
static void plain_transmission(const ec_scene *scene, ec_material *m)
{
    float least, most;
    ec_texture_range(scene, &m->textures[EC_SLOT_METALLIC_ROUGHNESS], 2, &least, &most);
    if (m->metallic * least == 1.0f) m->transmission = 0.0f;
    if (!(m->metallic * least < 1.0f)) m->diffuse_transmission = 0.0f;
    ec_texture_range(scene, &m->textures[EC_SLOT_TRANSMISSION], 0, &least, &most);
    if (m->transmission * least == 1.0f) m->diffuse_transmission = 0.0f; /* no light is left for it */
    if (!ec_refracts(m) || m->ior <= 1.0f) m->dispersion = 0.0f;
    if (!ec_refracts(m) && !ec_bounds(m)) memset(m->absorption, 0, sizeof m->absorption);
    for (int k = 0; k < 3; k++)
        if (m->absorption[k] == 0.0f) m->scatter[k] = 0.0f; /* there is no extinction of which it could be a share */
}

/* Removes a film without thickness, or of air; and the texture of one with the same thickness everywhere. */
static void plain_film(const ec_scene *scene, ec_material *m)
{
    float low, high;
    ec_texture_range(scene, &m->textures[EC_SLOT_IRIDESCENCE_THICKNESS], 1, &low, &high);
    bool thick = (m->film_least > 0.0f && low < 1.0f) || (m->film_most > 0.0f && high > 0.0f);
    if (m->film_ior == 1.0f || !thick) m->film = 0.0f;
    if (low == high) m->film_most = low * m->film_most + (1.0f - low) * m->film_least;
    if (low == high || m->film_least == m->film_most) drop(m, EC_SLOT_IRIDESCENCE_THICKNESS);
}

/* Removes anisotropy at roughness 1, where a lobe is equally wide in all directions. */
static void plain_anisotropy(const ec_scene *scene, ec_material *m)
{
    float least, most, unused;
    ec_texture_range(scene, &m->textures[EC_SLOT_ANISOTROPY], 2, &unused, &most);
    ec_texture_range(scene, &m->textures[EC_SLOT_METALLIC_ROUGHNESS], 1, &least, &unused);
    if (!(m->anisotropy * most > 0.0f && m->roughness * least < 1.0f)) m->anisotropy = 0.0f;
}

/* Removes effects from a material that shows only its base colour. */
static void clear_lobes(ec_material *m)
{
    for (int k = 0; k < EC_SLOT_COUNT; k++)
        if (k != EC_SLOT_BASE_COLOR) drop(m, k);
    ec_material_clear(m, EC_FEATURE_ALL);
}

/* Removes everything from a material that no ray sees. */
static void plain_unseen(ec_material *m)
{
    clear_lobes(m);
    m->unlit = false;
}

/* Simplifies alpha by the range of the coverage: whether it leaves anything open, or shows anything. Allows for the rounding of a product and a
 * bilinear look-up. */
static void plain_alpha(const ec_scene *scene, ec_material *m, const shown *s)
{
    if (m->alpha_mode == EC_ALPHA_OPAQUE) return;
    const bool textured = m->textures[EC_SLOT_BASE_COLOR].texture >= 0;
    float least, most;
    ec_texture_range(scene, &m->textures[EC_SLOT_BASE_COLOR], 3, &least, &most);
    const float low = m->base_color[3] * least * s->least_alpha;
    const bool mask = m->alpha_mode == EC_ALPHA_MASK, varies = s->least_alpha != s->most_alpha;
    const float slack = textured || varies ? EC_TEXTURE_SLACK : 0.0f;
    const bool hidden = ec_alpha_hides(scene, m, s->most_alpha, varies);
    if (mask ? low * (1.0f - slack) >= m->alpha_cutoff : low >= 1.0f) m->alpha_mode = EC_ALPHA_OPAQUE;
    if (hidden) plain_unseen(m);
}

/* Replaces an anisotropy texture that is the same everywhere by a rotation and a strength, if the texture's u axis is the mesh's. */
static void plain_direction(const ec_scene *scene, ec_material *m)
{
    const ec_texture_use *use = &m->textures[EC_SLOT_ANISOTROPY];
    const float *t = use->transform;
    const bool as_is = use->uv_set == 0 && t[0] == 1.0f && t[1] == 0.0f && t[3] == 0.0f && t[4] == 1.0f;
    float low[3], high;
    if (use->texture < 0 || !as_is) return;
    for (int k = 0; k < 3; k++) {
        ec_texture_range(scene, use, k, &low[k], &high);
        if (low[k] != high) return;
    }
    m->anisotropy_rotation += atan2f(2.0f * low[1] - 1.0f, 2.0f * low[0] - 1.0f);
    m->anisotropy *= low[2];
    drop(m, EC_SLOT_ANISOTROPY);
}

static void plain_material(const ec_scene *scene, ec_material *m, const shown *s)
{
    if (m->unlit) clear_lobes(m);
    for (int slot = 0; slot < EC_SLOT_COUNT; slot++) ec_texture_fold(scene, m, slot);
    plain_direction(scene, m);
    plain_alpha(scene, m, s);
    if (m->alpha_mode == EC_ALPHA_OPAQUE) {
        m->base_color[3] = 0.0f; /* it is not used, so the texture's alpha may be anything */
        ec_texture_fold(scene, m, EC_SLOT_BASE_COLOR);
    }
    plain_transmission(scene, m);
    plain_film(scene, m);
    plain_anisotropy(scene, m);
    if (m->specular == 0.0f) drop(m, EC_SLOT_SPECULAR_COLOR);
    if (m->normal_scale == 0.0f) drop(m, EC_SLOT_NORMAL);
    if (m->coat_normal_scale == 0.0f) drop(m, EC_SLOT_CLEARCOAT_NORMAL);
    for (int slot = 0; slot < EC_SLOT_COUNT; slot++)
        if (ec_material_slots[slot].effect && !ec_material_has(m, ec_material_slots[slot].effect)) drop(m, slot);
}

static void look_at_triangles(const ec_scene *scene, shown *list)
{
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        shown *s = &list[scene->triangle_material[t]];
        if (!s->any) *s = (shown){true, 1.0f, scene->colors ? 0.0f : 1.0f};
        if (!scene->colors) continue;
        for (int v = 0; v < 3; v++) {
            float alpha = scene->colors[4 * (size_t)scene->indices[3 * (size_t)t + (size_t)v] + 3];
            s->least_alpha = fminf(s->least_alpha, alpha);
            s->most_alpha = fmaxf(s->most_alpha, alpha);
        }
    }
}

static void plain_lights(ec_scene *scene)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < scene->light_count; i++)
        if (ec_pack_punctual_power(&scene->lights[i], 1.0) > 0.0) scene->lights[kept++] = scene->lights[i];
    scene->light_count = kept;
}

static void plain_environment(ec_scene *scene)
{
    ec_environment *e = &scene->environment;
    if (!scene->has_environment) return;
    size_t values = 3 * (size_t)e->width * e->height, i = 3;
    while (e->rgb && i < values && e->rgb[i] == e->rgb[i % 3]) i++;
    if (e->rgb && values && i >= values) {
        memcpy(e->constant, e->rgb, sizeof e->constant);
        e->rgb = NULL;
        e->width = e->height = 0;
    }
    if (!e->rgb && is_zero(e->constant)) scene->has_environment = false;
}

ec_result ec_scene_view_plain(const ec_scene *scene, ec_scene_view *view, ec_error *err)
{
    EC_FREED shown *list = calloc(scene->material_count + 1, sizeof *list);
    if (!list) return ec_fail(err, "out of memory for %u materials", scene->material_count);
    EC_TRY(ec_scene_view_make(scene, view, err));
    look_at_triangles(scene, list);
    for (uint32_t m = 0; m < scene->material_count; m++) {
        if (list[m].any) {
            plain_material(scene, &view->scene.materials[m], &list[m]);
            continue;
        }
        plain_unseen(&view->scene.materials[m]); /* no triangle has it */
        drop(&view->scene.materials[m], EC_SLOT_BASE_COLOR);
    }
    plain_lights(&view->scene);
    plain_environment(&view->scene);
    return EC_OK;
}
