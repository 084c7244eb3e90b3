/* Loads the textures and images that the scene's triangles use; no others are opened. They are first collected, then decoded by all threads, and
 * added in the order in which materials name them: messages and order do not depend on the number of threads. */
#include "base/freed.h"
#include "base/text.h"
#include "gltf/flatten.h"
#include "gltf/image_decode.h"
#include "scene/texels.h"
#include "scene/texture_range.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An image of the file on its way into the scene. */
typedef struct picture {
    bool is_wanted, is_fetched;
    uint32_t index;               /* index in the file */
    const uint8_t *stored;        /* the encoded bytes */
    uint64_t bytes;               /* their number */
    uint8_t *owned;               /* to be freed, or NULL */
    const ec_gltf_texture *gloss; /* not NULL: becomes metallic-roughness, by that texture's factor */
    ec_image image;
    ec_error err;                 /* why it failed, if `failed`; else how it is damaged, or "" */
    bool failed;
    int64_t place;                /* index in the scene; UNSEEN or UNUSABLE */
} picture;

typedef struct table {
    ec_gltf *g;
    ec_scene *s;
    const ec_log *log;
    picture *pictures; /* one for each image, then one for each texture that needs a picture of its own */
    picture **wanted;  /* the wanted ones, in the order in which materials name them */
    int64_t wanted_count;
    int64_t *texture;  /* by glTF texture: texture of the scene; UNSEEN or UNUSABLE */
    int slot;          /* the slot whose use is being visited */
    ec_result result;
    ec_error *err;
} table;

enum { UNSEEN = -1, UNUSABLE = -2 };

/* Gets the encoded bytes of an image; the caller frees *owned. Returns false if there are none; err says why. */
static bool fetch_bytes(const ec_gltf *g, uint32_t index, const uint8_t **bytes, uint64_t *length, uint8_t **owned, ec_error *err)
{
    const ec_gltf_image *in = &g->images[index];
    const ec_label label = ec_label_of("images", index, in->name);
    const char *where = label.text;
    err->text[0] = 0;
    if (in->uri) {
        if (ec_gltf_uri_load(g, where, in->uri, owned, length, err) != EC_OK) return false;
        *bytes = *owned;
        return true;
    }
    const ec_gltf_view *v = in->view >= 0 ? &g->views[in->view] : NULL;
    if (!v) return ec_fail(err, "%s has neither uri nor bufferView", where) == EC_OK;
    if (!g->buffers[v->buffer].data) return ec_fail(err, "%s reads buffers[%d], which has no data", where, v->buffer) == EC_OK;
    *bytes = g->buffers[v->buffer].data + v->offset;
    *length = v->length;
    return true;
}

static bool no_memory(const char *where, ec_error *err)
{
    ec_fail(err, "%s: out of memory", where);
    err->kind = EC_ERROR_HOST_MEMORY;
    return false;
}

/* Decodes an image's bytes. Returns false if that fails, and err says why; otherwise err says how the image is damaged, or "". */
static bool decode_bytes(const ec_gltf *g, uint32_t index, const uint8_t *bytes, uint64_t length, ec_image *out, ec_error *err)
{
    const char *name = g->images[index].name;
    const ec_label label = ec_label_of("images", index, name);
    ec_decode_error reason = {0};
    if (!ec_image_decode(bytes, length, out, &reason)) {
        ec_image_free(out);
        if (reason.out_of_memory) return no_memory(label.text, err);
        return ec_fail(err, "%s cannot be decoded: %s", label.text, reason.text) == EC_OK;
    }
    if (reason.text[0]) ec_fail(err, "%s is damaged or truncated: %s", label.text, reason.text);
    if (!name || (out->name = strdup(name))) return true;
    ec_image_free(out);
    return no_memory(label.text, err);
}

bool ec_gltf_image_load(const ec_gltf *g, uint32_t index, ec_image *out, ec_error *err)
{
    const uint8_t *bytes = NULL;
    uint8_t *owned = NULL;
    uint64_t length = 0;
    const bool ok = fetch_bytes(g, index, &bytes, &length, &owned, err) && decode_bytes(g, index, bytes, length, out, err);
    free(owned);
    return ok;
}

/* Makes metallic-roughness of a picture whose alpha is glossiness: green becomes 1 - factor x alpha, blue (metal) 0. */
static void make_roughness(ec_image *image, double glossiness)
{
    for (size_t i = 0; i < 4 * (size_t)image->width * image->height; i += 4) {
        double gloss = glossiness * (image->rgba8 ? image->rgba8[i + 3] / 255.0 : image->rgba16[i + 3] / 65535.0);
        if (image->rgba8) image->rgba8[i + 1] = (uint8_t)(255 * (1 - gloss) + 0.5), image->rgba8[i + 2] = 0;
        else image->rgba16[i + 1] = (uint16_t)(65535 * (1 - gloss) + 0.5), image->rgba16[i + 2] = 0;
    }
}

/* Returns the place where an animation keeps the pixels for all its scenes; NULL: it does not. */
static ec_image *kept_of(const table *t, const picture *p) { return t->g->decoded && !p->gloss ? &t->g->decoded[p->index] : NULL; }

/* Gets an image's bytes and, if the header tells it, its size, unless it is decoded already. */
static void fetch(const table *t, picture *p)
{
    const ec_image *kept = kept_of(t, p);
    p->err.text[0] = 0;
    if (kept && kept->width) {
        p->image = *kept;
        return;
    }
    p->is_fetched = fetch_bytes(t->g, p->index, &p->stored, &p->bytes, &p->owned, &p->err);
    p->failed = !p->is_fetched;
    if (p->is_fetched && !ec_image_size(p->stored, p->bytes, &p->image.width, &p->image.height)) p->image.width = p->image.height = 0;
}

static void decode(const table *t, picture *p)
{
    if (!p->is_fetched) return;
    p->failed = !decode_bytes(t->g, p->index, p->stored, p->bytes, &p->image, &p->err);
    free(p->owned);
    p->owned = NULL;
    if (p->failed) return;
    if (p->gloss) make_roughness(&p->image, (double)p->gloss->glossiness);
    ec_image_find_range(&p->image);
}

/* A picture that cannot be read does not stop a render: it is taken as white or, if it holds directions, left out. Lack of memory does stop it. */
static const char *instead_of(const table *t)
{
    bool directions = t->slot == EC_SLOT_NORMAL || t->slot == EC_SLOT_CLEARCOAT_NORMAL || t->slot == EC_SLOT_ANISOTROPY;
    return directions ? "the map is left out" : "it is taken as white";
}

static int64_t take_picture(table *t, picture *p)
{
    if (p->place != UNSEEN) return p->place;
    ec_image *out = &t->s->images[t->s->image_count], *kept = kept_of(t, p);
    if (p->failed) {
        const char *why = p->err.text;
        if (p->err.kind != EC_ERROR_HOST_MEMORY) ec_warn(t->log, "%s: %.*s; %s", t->g->path, EC_CUT(why, 1200), instead_of(t));
        else if (t->result == EC_OK) t->result = ec_fail(t->err, "%s: %.*s", t->g->path, EC_CUT(why, 1200));
        if (!t->s->lost_image) t->s->lost_image = strdup(why);
        return p->place = UNUSABLE;
    }
    if (p->err.text[0]) ec_warn(t->log, "%s: %.*s; what could be decoded is used", t->g->path, EC_CUT(p->err.text, 1200));
    *out = p->image;
    if (kept) *kept = p->image, out->lent = true;
    return p->place = t->s->image_count++;
}

static picture *picture_of(const table *t, int32_t texture)
{
    const ec_gltf_texture *in = &t->g->textures[texture];
    return &t->pictures[in->is_gloss ? t->g->image_count + (uint32_t)texture : (uint32_t)in->image];
}

static void want(table *t, bool drawn, ec_texture_use *use)
{
    const ec_gltf_texture *in = drawn && use->texture >= 0 ? &t->g->textures[use->texture] : NULL;
    if (!in || in->image < 0) return;
    picture *p = picture_of(t, use->texture);
    if (p->is_wanted) return;
    *p = (picture){.is_wanted = true, .index = (uint32_t)in->image, .gloss = in->is_gloss ? in : NULL, .place = UNSEEN};
    t->wanted[t->wanted_count++] = p;
}

static int64_t map_texture(table *t, int32_t index)
{
    if (t->texture[index] != UNSEEN) return t->texture[index];
    const ec_gltf_texture *in = &t->g->textures[index];
    if (in->image < 0)
        ec_warn(t->log, "%s: textures[%d] has no image in a supported format; %s", t->g->path, index, instead_of(t));
    int64_t image = in->image < 0 ? UNUSABLE : take_picture(t, picture_of(t, index));
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

/* Visits every texture use of every material. drawn: by material. */
static void for_each_use(table *t, const bool *drawn, void (*look)(table *t, bool drawn, ec_texture_use *use))
{
    for (uint32_t i = 0; i < t->s->material_count; i++) {
        ec_material *m = &t->s->materials[i];
        for (int k = 0; k < EC_SLOT_COUNT; k++) {
            bool shows = !m->unlit || k == EC_SLOT_BASE_COLOR || k == EC_SLOT_EMISSION;
            t->slot = k;
            look(t, drawn[i] && shows, &m->textures[k]);
        }
    }
}

/* Allocates one block, laid out as kernels read it, for the pictures whose size is known, so that they are decoded in place. Without memory for it
 * each picture has its own. */
static void make_room(const table *t)
{
    uint64_t count = 0;
    for (int64_t i = 0; i < t->wanted_count; i++)
        if (t->wanted[i]->is_fetched) count += (uint64_t)t->wanted[i]->image.width * t->wanted[i]->image.height;
    ec_texels *texels = count && count <= UINT32_MAX ? ec_texels_make(count) : NULL;
    uint32_t *words = texels ? texels->words : NULL;
    for (int64_t i = 0; i < t->wanted_count; i++) {
        ec_image *image = &t->wanted[i]->image;
        if (!t->wanted[i]->is_fetched || !image->width) continue;
        if (!words) {
            image->width = image->height = 0;
            continue;
        }
        image->texels = ec_texels_keep(texels);
        image->rgba8 = (uint8_t *)words;
        words += (size_t)image->width * image->height;
    }
    ec_texels_leave(texels);
}

static int by_bytes(const void *a, const void *b)
{
    const picture *const *x = a, *const *y = b;
    if ((*x)->bytes != (*y)->bytes) return (*x)->bytes > (*y)->bytes ? -1 : 1;
    return *x < *y ? -1 : *x > *y;
}

/* Decodes the largest picture first, so that no thread starts on it when the others are about to end. */
static void decode_all(const table *t)
{
    const int64_t count = t->wanted_count;
#pragma omp parallel for schedule(dynamic, 1) if (count > 1)
    for (int64_t i = 0; i < count; i++) fetch(t, t->wanted[i]);
    make_room(t);
    qsort(t->wanted, (size_t)count, sizeof(picture *), by_bytes);
#pragma omp parallel for schedule(dynamic, 1) if (count > 1)
    for (int64_t i = 0; i < count; i++) decode(t, t->wanted[i]);
}

/* Marks the materials of primitives that are placed. */
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
    const size_t most = (size_t)g->image_count + g->texture_count; /* the images, and roughness made of glossiness */
    EC_FREED picture *pictures = calloc(most + 1, sizeof *pictures);
    EC_FREED int64_t *texture = malloc(((size_t)g->texture_count + 1) * sizeof *texture);
    EC_FREED picture **wanted = malloc((most + 1) * sizeof(picture *));
    EC_FREED bool *drawn = calloc((size_t)s->material_count + 1, sizeof *drawn);
    table t = {.g = g, .s = s, .log = log, .pictures = pictures, .wanted = wanted, .texture = texture, .err = err};
    s->images = calloc(most + 1, sizeof *s->images);
    s->textures = calloc((size_t)g->texture_count + 1, sizeof *s->textures);
    if (!pictures || !wanted || !texture || !s->images || !s->textures || !drawn)
        return ec_fail(err, "%s: out of memory for textures", g->path);
    for (uint32_t i = 0; i < g->texture_count; i++) texture[i] = UNSEEN;
    mark_drawn(g, placements, drawn);
    for_each_use(&t, drawn, want);
    decode_all(&t);
    for_each_use(&t, drawn, map_use);
    return t.result;
}
