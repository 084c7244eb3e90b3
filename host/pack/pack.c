#include "pack/pack.h"

#include <math.h>
#include <string.h>

#include "base/freed.h"
#include "base/memory.h"
#include "pack/coplanar.h"
#include "scene/material_fields.h"
#include "scene/texels.h"

static ec_result pack_prims(const ec_scene *scene, ec_pack *pack, ec_error *err)
{
    pack->prim_count = scene->triangle_count;
    pack->prims = ec_shared_alloc(((size_t)pack->prim_count + 1) * sizeof *pack->prims);
    EC_FREED bool *is_pane = calloc(scene->material_count, sizeof *is_pane);
    if (!pack->prims || !is_pane) return ec_fail(err, "out of memory for %u triangles", pack->prim_count);
    memset(&pack->prims[pack->prim_count], 0, sizeof *pack->prims);
    for (uint32_t m = 0; m < scene->material_count; m++) is_pane[m] = ec_pack_is_pane(scene, &scene->materials[m]);
    for (uint32_t t = 0; t < pack->prim_count; t++) {
        const uint32_t *i = scene->indices + 3 * (size_t)t;
        const ec_material *m = &scene->materials[scene->triangle_material[t]];
        ec_prim *p = &pack->prims[t];
        memcpy(p->v0, scene->positions + 3 * (size_t)i[0], sizeof p->v0);
        memcpy(p->v1, scene->positions + 3 * (size_t)i[1], sizeof p->v1);
        memcpy(p->v2, scene->positions + 3 * (size_t)i[2], sizeof p->v2);
        p->material = scene->triangle_material[t];
        p->light_pdf_a = 0.0f;
        p->flags = (m->double_sided || ec_refracts(m) || ec_bounds(m) ? 0 : EC_PRIM_SINGLE_SIDED) |
                   (m->alpha_mode != EC_ALPHA_OPAQUE ? EC_PRIM_ALPHA : 0) | (is_pane[p->material] ? EC_PRIM_PANE : 0);
    }
    for (int k = 0; k < 3; k++) {
        float extent = fmaxf(fabsf(scene->bounds_min[k]), fabsf(scene->bounds_max[k]));
        pack->scene_max = fmaxf(pack->scene_max, extent);
        pack->scene_radius += extent * extent;
    }
    pack->scene_radius = sqrtf(pack->scene_radius) * 1.001f;
    if (!pack->prim_count) pack->scene_radius = 1.0f; /* otherwise a sky around nothing would have no power */
    return EC_OK;
}

/* Packs a slot. One without a texture is reset completely: a rotation left in it would turn tangents. */
static void pack_slot(const ec_scene *scene, const ec_texture_use *use, int is_srgb, ec_texture_slot *slot)
{
    static const ec_texture_use none = {-1, 0, {1, 0, 0, 0, 1, 0}};
    slot->texture = ec_pack_texture_index(scene, use, is_srgb);
    if (slot->texture < 0) use = &none;
    slot->uv_set = use->uv_set;
    memcpy(slot->transform, use->transform, sizeof slot->transform);
}

/* Returns the reflectance of a dielectric in air, seen head-on. KHR_materials_ior: an index of 0 stands for an infinite one. */
static float head_on_reflectance(float ior)
{
    float r = ior == 0.0f ? 1.0f : (ior - 1.0f) / (ior + 1.0f);
    return r * r;
}

/* KHR_materials_volume_scatter: returns the single-scattering albedo of a dense body that is seen in this colour (Kulla and Conty 2017). */
static float single_albedo(float color, float g)
{
    const double c = color, s = 4.09712 + 4.20863 * c - sqrt(9.59217 + 41.6808 * c + 17.7126 * c * c);
    return c > 0 ? (float)fmin(fmax((1 - s * s) / (1 - g * s * s), 0), 1) : 0.0f;
}

/* Marks nested bodies. Between bodies reflectance depends on both sides: the kernels multiply by it. */
static void pack_bodies(const ec_scene *scene, ec_pack *pack)
{
    for (uint32_t rank = 0; rank < pack->bodies.count; rank++) {
        uint32_t material = pack->bodies.material[rank];
        ec_material_data *d = &pack->materials[material];
        d->flags |= EC_MATERIAL_NESTED;
        d->body = 1u << rank;
        if (ec_refracts(&scene->materials[material])) memcpy(d->f0, scene->materials[material].specular_color, sizeof d->f0);
        pack->materials[rank].body_of_rank = material * EC_MATERIAL_WORDS;
    }
}

#define COPY(field, floats, value, least, most, slot, channel, effect, has, path) memcpy(&d->field, &m->field, sizeof d->field);
#define WORKED_OUT(...)
#define OF_KERNELS(...)
static ec_result pack_materials(const ec_scene *scene, ec_pack *pack, ec_error *err)
{
    pack->material_count = scene->material_count;
    pack->materials = calloc(scene->material_count, sizeof *pack->materials);
    if (!pack->materials) return ec_fail(err, "out of memory for %u materials", scene->material_count);
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const ec_material *m = &scene->materials[i];
        ec_material_data *d = &pack->materials[i];
        EC_MATERIAL_FIELDS(COPY, WORKED_OUT, OF_KERNELS, OF_KERNELS)
        for (int k = 0; k < 3; k++) d->f0[k] = m->specular_color[k] * head_on_reflectance(m->ior);
        d->flags = (m->double_sided ? EC_MATERIAL_DOUBLE_SIDED : 0) | (ec_emits(m) && !m->unlit ? EC_MATERIAL_EMISSIVE : 0) |
                   (m->unlit ? EC_MATERIAL_UNLIT : 0) | (m->alpha_mode == EC_ALPHA_MASK ? EC_MATERIAL_MASK : 0) |
                   (m->alpha_mode == EC_ALPHA_BLEND ? EC_MATERIAL_BLEND : 0) | (ec_refracts(m) ? EC_MATERIAL_REFRACTS : 0) |
                   (ec_bounds(m) ? EC_MATERIAL_BOUNDS : 0) | (ec_pack_is_matched(scene, m) ? EC_MATERIAL_MATCHED : 0);
        for (int k = 0; k < 3; k++) d->scatter_albedo[k] = single_albedo(m->scatter[k], m->scatter_anisotropy);
        d->anisotropy_cosine = cosf(m->anisotropy_rotation);
        d->anisotropy_sine = sinf(m->anisotropy_rotation);
        for (int k = 0; k < EC_SLOT_COUNT; k++) pack_slot(scene, &m->textures[k], ec_material_slots[k].is_srgb, &d->slots[k]);
    }
    return EC_OK;
}

ec_result ec_pack_scene(const ec_scene *all, ec_pack *pack, ec_error *err)
{
    memset(pack, 0, sizeof *pack);
    EC_TRY(ec_scene_view_plain(all, &pack->plain, err));
    const ec_scene *scene = &pack->plain.scene;
    ec_result result = ec_pack_find_bodies(scene, &pack->bodies, err);
    if (result == EC_OK) result = ec_pack_effects(scene, &pack->bodies, &pack->effects, err);
    if (result == EC_OK) result = pack_prims(scene, pack, err);
    if (result == EC_OK) result = ec_pack_textures(scene, pack, err);
    if (result == EC_OK) result = pack_materials(scene, pack, err);
    if (result == EC_OK) result = ec_pack_places(scene, pack, err);
    if (result == EC_OK) result = ec_pack_motion(scene, pack, err);
    if (result == EC_OK) result = ec_pack_coplanar(scene, pack, err);
    if (result == EC_OK) result = ec_bodies_rank(scene, &pack->bodies, err);
    if (result == EC_OK) pack_bodies(scene, pack);
    if (result == EC_OK) result = ec_pack_lights(scene, pack, err);
    if (result != EC_OK) ec_pack_free(pack);
    return result;
}

void ec_pack_free(ec_pack *pack)
{
    ec_scene_view_free(&pack->plain);
    if (!pack->prims_lent) free(pack->prims);
    free(pack->materials);
    free(pack->textures);
    ec_texels_leave(pack->texels);
    free(pack->places);
    free(pack->motion);
    free(pack->coplanar);
    free(pack->lights);
    free(pack->light_source);
    free(pack->light_shares);
    free(pack->light_of_prim);
    free(pack->light_tree);
    free(pack->lamp_nodes);
    free(pack->pair_of_prim);
    free(pack->bulbs);
    free(pack->emission);
    if (!pack->environment_lent) free(pack->environment_texels);
    if (!pack->environment_lent) free(pack->environment_table);
    memset(pack, 0, sizeof *pack);
}
