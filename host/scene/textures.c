/* The textures and images that the scene's triangles use; no others are opened. */
#include "scene/flatten.h"
#include "scene/image_decode.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct table {
    ec_gltf *g;
    ec_scene *s;
    const ec_log *log;
    int64_t *image;   /* glTF image -> scene image; UNSEEN or UNUSABLE */
    int64_t *texture; /* likewise */
    ec_result result;
    ec_error *err;
} table;

enum { UNSEEN = -1, UNUSABLE = -2 };

static ec_result get_bytes(const ec_gltf *g, const ec_gltf_image *in, const char *where, const uint8_t **bytes,
                           uint64_t *length, uint8_t **owned, ec_error *err)
{
    if (in->uri) {
        EC_TRY(ec_gltf_uri_load(g->folder, where, in->uri, owned, length, err));
        *bytes = *owned;
        return EC_OK;
    }
    if (in->view < 0) return ec_fail(err, "%s has neither uri nor bufferView", where);
    const ec_gltf_view *v = &g->views[in->view];
    if (!g->buffers[v->buffer].data) return ec_fail(err, "%s reads buffers[%d], which has no data", where, v->buffer);
    *bytes = g->buffers[v->buffer].data + v->offset;
    *length = v->length;
    return EC_OK;
}

static bool no_memory(const char *where, ec_error *err)
{
    ec_fail(err, "%s: out of memory", where);
    err->kind = EC_ERROR_HOST_MEMORY;
    return false;
}

bool ec_gltf_image_load(const ec_gltf *g, uint32_t index, ec_image *out, ec_error *err)
{
    const ec_gltf_image *in = &g->images[index];
    char where[160];
    snprintf(where, sizeof where, in->name ? "images[%u] \"%.80s\"" : "images[%u]", index, in->name);
    const uint8_t *bytes = NULL;
    uint8_t *owned = NULL;
    uint64_t length = 0;
    ec_decode_error reason = {0};
    bool ok = get_bytes(g, in, where, &bytes, &length, &owned, err) == EC_OK;
    if (ok && !ec_image_decode(bytes, length, out, &reason)) {
        ok = false;
        *out = (ec_image){0};
        if (reason.out_of_memory) no_memory(where, err);
        else ec_fail(err, "%s cannot be decoded: %s", where, reason.text);
    }
    free(owned);
    if (!ok || !in->name || (out->name = strdup(in->name))) return ok;
    free(out->rgba8);
    free(out->rgba16);
    *out = (ec_image){0};
    return no_memory(where, err);
}

/* A picture that cannot be had does not stop a render: the material's factors stand alone, as if it were white. One that there is no
 * memory for does. */
static bool decode_now(table *t, uint32_t index, ec_image *out)
{
    ec_error err;
    if (ec_gltf_image_load(t->g, index, out, &err)) return true;
    if (err.kind == EC_ERROR_HOST_MEMORY) t->result = ec_fail(t->err, "%s: %.1200s", t->g->path, err.text);
    else ec_warn(t->log, "%s: %.1200s; taken as white", t->g->path, err.text);
    return false;
}

/* Where an animation keeps them, the same pixels serve all its scenes. */
static bool decode(table *t, uint32_t index, ec_image *out)
{
    ec_image *kept = t->g->decoded ? &t->g->decoded[index] : NULL;
    if (!kept) return decode_now(t, index, out);
    if (!kept->width && !decode_now(t, index, kept)) return false;
    *out = *kept;
    out->lent = true;
    return true;
}

static int64_t map_image(table *t, int32_t index)
{
    if (index < 0) return UNUSABLE;
    if (t->image[index] != UNSEEN) return t->image[index];
    ec_image *out = &t->s->images[t->s->image_count];
    if (decode(t, (uint32_t)index, out)) {
        t->image[index] = t->s->image_count++;
    } else {
        t->image[index] = UNUSABLE;
    }
    return t->image[index];
}

/* Metallic-roughness of a picture whose alpha is glossiness: green 1 - factor x alpha, no metal. */
static int64_t make_roughness(table *t, const ec_gltf_texture *in)
{
    ec_image *out = &t->s->images[t->s->image_count];
    if (in->image < 0 || !decode_now(t, (uint32_t)in->image, out)) return UNUSABLE;
    for (size_t i = 0; i < 4 * (size_t)out->width * out->height; i += 4) {
        double gloss = (double)in->glossiness * (out->rgba8 ? out->rgba8[i + 3] / 255.0 : out->rgba16[i + 3] / 65535.0);
        if (out->rgba8) out->rgba8[i + 1] = (uint8_t)(255 * (1 - gloss) + 0.5), out->rgba8[i + 2] = 0;
        else out->rgba16[i + 1] = (uint16_t)(65535 * (1 - gloss) + 0.5), out->rgba16[i + 2] = 0;
    }
    return t->s->image_count++;
}

static int64_t map_texture(table *t, int32_t index)
{
    if (t->texture[index] != UNSEEN) return t->texture[index];
    const ec_gltf_texture *in = &t->g->textures[index];
    if (in->image < 0)
        ec_warn(t->log, "%s: textures[%d] has no image in a format that is read; taken as white", t->g->path, index);
    int64_t image = in->is_gloss ? make_roughness(t, in) : map_image(t, in->image);
    if (image < 0) return t->texture[index] = UNUSABLE;
    t->s->textures[t->s->texture_count] = (ec_texture){(uint32_t)image, in->wrap_s, in->wrap_t, in->nearest};
    return t->texture[index] = t->s->texture_count++;
}

static void map_use(table *t, bool drawn, ec_texture_use *use)
{
    if (use->texture < 0) return;
    int64_t texture = drawn ? map_texture(t, use->texture) : UNUSABLE;
    use->texture = texture < 0 ? -1 : (int32_t)texture;
}

static void map_materials(table *t, const bool *drawn)
{
    for (uint32_t i = 0; i < t->s->material_count; i++) {
        ec_material *m = &t->s->materials[i];
        for (int k = 0; k < EC_SLOT_COUNT; k++) {
            bool shows = !m->unlit || k == EC_SLOT_BASE_COLOR || k == EC_SLOT_EMISSION;
            map_use(t, drawn[i] && shows, &m->textures[k]);
        }
    }
}

/* By material: does a primitive that stands somewhere have it? */
static void mark_drawn(const ec_gltf *g, const ec_placement_list *placements, bool *drawn)
{
    for (uint32_t i = 0; i < placements->count; i++) {
        int32_t mesh = placements->items[i].mesh;
        for (uint32_t k = 0; mesh >= 0 && k < g->meshes[mesh].primitive_count; k++) {
            const ec_gltf_primitive *p = &g->meshes[mesh].primitives[k];
            if (p->drawn) drawn[p->scene_material] = true;
        }
    }
}

ec_result ec_gltf_textures_load(ec_gltf *g, const ec_placement_list *placements, ec_scene *s, const ec_log *log, ec_error *err)
{
    table t = {.g = g, .s = s, .log = log, .err = err};
    t.image = malloc(((size_t)g->image_count + 1) * sizeof *t.image);
    t.texture = malloc(((size_t)g->texture_count + 1) * sizeof *t.texture);
    s->images = calloc((size_t)g->image_count + g->texture_count + 1, sizeof *s->images); /* and roughness made of glossiness */
    s->textures = calloc((size_t)g->texture_count + 1, sizeof *s->textures);
    bool *drawn = calloc((size_t)s->material_count + 1, sizeof *drawn);
    bool ok = t.image && t.texture && s->images && s->textures && drawn;
    if (ok) {
        for (uint32_t i = 0; i < g->image_count; i++) t.image[i] = UNSEEN;
        for (uint32_t i = 0; i < g->texture_count; i++) t.texture[i] = UNSEEN;
        mark_drawn(g, placements, drawn);
        map_materials(&t, drawn);
    }
    free(t.image);
    free(t.texture);
    free(drawn);
    return ok ? t.result : ec_fail(err, "%s: out of memory for textures", g->path);
}
