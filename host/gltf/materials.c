/* Makes the scene's materials: the file's, glTF's default if something needs it, and variants for meshes that lack a texture coordinate set. */
#include "base/freed.h"
#include "gltf/flatten.h"
#include "scene/material_fields.h"

static ec_result append(ec_scene *s, ec_material material, ec_error *err)
{
    ec_material *grown = realloc(s->materials, (s->material_count + 1) * sizeof *grown);
    if (!grown) return ec_fail(err, "out of memory for materials");
    s->materials = grown;
    s->materials[s->material_count++] = material;
    return EC_OK;
}

/* Returns the sets that the material reads and the primitive lacks: bit i for TEXCOORD_i. */
static unsigned missing_sets(const ec_material *m, const ec_gltf_primitive *p)
{
    unsigned missing = 0;
    for (int i = 0; i < EC_SLOT_COUNT; i++)
        if (m->textures[i].texture >= 0 && p->streams.of[EC_UV + m->textures[i].uv_set] < 0) missing |= 1u << m->textures[i].uv_set;
    return missing;
}

static ec_result append_variant(ec_scene *s, uint32_t original, unsigned missing, ec_error *err)
{
    ec_material variant = s->materials[original];
    if (variant.name && !(variant.name = strdup(variant.name))) return ec_fail(err, "out of memory for materials");
    for (int i = 0; i < EC_SLOT_COUNT; i++)
        if (variant.textures[i].texture >= 0 && missing >> variant.textures[i].uv_set & 1) variant.textures[i].texture = -1;
    ec_result result = append(s, variant, err);
    if (result != EC_OK) free(variant.name);
    return result;
}

/* Finds or makes the material of a primitive. variants: for every material of the file, and the default at the end, the scene's index plus one for
 * each combination of missing texture coordinate sets; 0: not made yet. */
static ec_result assign(const ec_gltf *g, ec_scene *s, ec_gltf_primitive *p, uint32_t mesh, uint32_t *variants,
                        const ec_log *log, ec_error *err)
{
    uint32_t file_index = p->material >= 0 ? (uint32_t)p->material : g->material_count;
    uint32_t *slot = &variants[4 * file_index];
    if (!slot[0]) { /* only the default is not there from the start */
        EC_TRY(append(s, ec_material_default(), err));
        slot[0] = s->material_count;
    }
    uint32_t original = slot[0] - 1;
    unsigned missing = missing_sets(&s->materials[original], p);
    if (!slot[missing]) {
        EC_TRY(append_variant(s, original, missing, err));
        slot[missing] = s->material_count;
        ec_warn(log, "%s: %s has textures on TEXCOORD_%d%s, which meshes[%u] lacks; they are left out there", g->path,
                ec_label_of("materials", (uint32_t)p->material, s->materials[original].name).text, missing & 1 ? 0 : 1, missing == 3 ? " and 1" : "", mesh);
    }
    p->scene_material = slot[missing] - 1;
    return EC_OK;
}

ec_result ec_gltf_materials_assign(ec_gltf *g, ec_scene *s, const ec_log *log, ec_error *err)
{
    s->materials = g->materials; /* moved */
    s->material_count = g->material_count;
    g->materials = NULL;
    EC_FREED uint32_t *variants = calloc(4 * ((size_t)s->material_count + 1), sizeof *variants);
    if (!variants) return ec_fail(err, "out of memory for materials");
    for (uint32_t i = 0; i < s->material_count; i++) variants[4 * i] = i + 1;
    for (uint32_t i = 0; i < g->mesh_count; i++)
        for (uint32_t k = 0; k < g->meshes[i].primitive_count; k++) {
            ec_gltf_primitive *p = &g->meshes[i].primitives[k];
            if (p->drawn) EC_TRY(assign(g, s, p, i, variants, log, err));
        }
    return s->material_count ? EC_OK : append(s, ec_material_default(), err);
}
