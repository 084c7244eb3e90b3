#include "scene/matte_names.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/freed.h"
#include "base/murmur.h"

enum { FLOAT_WHOLE = 1 << 24, LABEL = 24 };

const char *const ec_matte_kind_names[EC_MATTE_KINDS] = {"CryptoObject", "CryptoMaterial", "CryptoAsset"};

typedef struct thing {
    const char *name;   /* NULL: use label */
    char label[LABEL];
    bool shown;         /* a triangle belongs to it */
} thing;

static const char *name_of(const thing *t) { return t->name && *t->name ? t->name : t->label; }

/* Hashes a name. The hash's bits must be a finite, normal float, as programs may take denormals for 0. */
static uint32_t hash_of(const thing *t)
{
    const uint32_t hash = ec_murmur3(name_of(t), strlen(name_of(t)), 0), exponent = hash >> 23 & 255;
    return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

static int compare(const void *a, const void *b) { return strcmp(name_of(*(const thing *const *)a), name_of(*(const thing *const *)b)); }

/* Writes the manifest: each name once, in alphabetical order. */
static char *write_manifest(const thing *things, uint32_t count)
{
    uint32_t shown = 0;
    char hex[12];
    EC_FREED const thing **by_name = malloc((count + 1) * sizeof *by_name);
    cJSON *root = by_name ? cJSON_CreateObject() : NULL;
    if (!root) return NULL;
    for (uint32_t i = 0; i < count; i++)
        if (things[i].shown) by_name[shown++] = &things[i];
    qsort(by_name, shown, sizeof *by_name, compare);
    for (uint32_t i = 0; i < shown; i++) {
        if (i && !compare(&by_name[i - 1], &by_name[i])) continue;
        snprintf(hex, sizeof hex, "%08x", hash_of(by_name[i]));
        cJSON_AddStringToObject(root, name_of(by_name[i]), hex);
    }
    char *text = cJSON_PrintUnformatted(root);
    cJSON_Delete(root);
    return text;
}

/* Lists all things of a kind, by index plus 1. */
static void list_nodes(const ec_scene *s, bool roots, thing *things)
{
    snprintf(things[0].label, LABEL, "ground");
    for (uint32_t i = 0; i < s->node_count; i++) {
        const uint32_t node = roots ? s->node_roots[i] : i;
        things[i + 1].name = s->node_names[node];
        snprintf(things[i + 1].label, LABEL, "node%u", node);
    }
    for (uint32_t i = 0; i < s->part_count; i++) things[s->parts[i].node == EC_NO_NODE ? 0 : s->parts[i].node + 1].shown = true;
}

static void list_materials(const ec_scene *s, thing *things)
{
    for (uint32_t i = 0; i < s->material_count; i++) {
        things[i + 1].name = s->materials[i].name;
        snprintf(things[i + 1].label, LABEL, "material%u", i);
    }
    for (uint32_t i = 0; i < s->triangle_count; i++) things[s->triangle_material[i] + 1].shown = true;
}

/* Makes keys: that of a kind's attributes is the beginning of its name's hash. */
static void write_keys(ec_matte_names *names, enum ec_matte_kind kind)
{
    static const char *const fields[EC_MATTE_FIELDS] = {"name", "hash", "conversion", "manifest"};
    const thing own = {.name = ec_matte_kind_names[kind]};
    char key[12];
    snprintf(key, sizeof key, "%08x", hash_of(&own));
    for (int k = 0; k < EC_MATTE_FIELDS; k++) snprintf(names->keys[kind][k], EC_MATTE_FIELD, "cryptomatte/%.7s/%s", key, fields[k]);
}

static ec_result find(const ec_scene *s, enum ec_matte_kind kind, ec_matte_names *names, ec_error *err)
{
    const uint32_t count = 1 + (kind == EC_MATTE_MATERIAL ? s->material_count : s->node_count);
    EC_FREED thing *things = calloc(count, sizeof *things);
    names->hashes[kind] = malloc(count * sizeof *names->hashes[kind]);
    if (!things || !names->hashes[kind]) return ec_fail(err, "out of memory for cryptomatte of %u things", count);
    if (kind == EC_MATTE_MATERIAL) list_materials(s, things);
    else list_nodes(s, kind == EC_MATTE_ASSET, things);
    for (uint32_t i = 0; i < count; i++) names->hashes[kind][i] = hash_of(&things[i]);
    names->manifests[kind] = write_manifest(things, count);
    write_keys(names, kind);
    return names->manifests[kind] ? EC_OK : ec_fail(err, "out of memory for cryptomatte of %u things", count);
}

ec_result ec_matte_names_find(const ec_scene *s, uint32_t kinds, ec_matte_names *names, ec_error *err)
{
    if (s->node_count >= FLOAT_WHOLE || s->material_count >= FLOAT_WHOLE)
        return ec_fail(err, "--channels cryptomatte: the scene has %u nodes and %u materials, but there can be at most %u of each", s->node_count, s->material_count, FLOAT_WHOLE - 1);
    for (uint32_t k = 0; k < EC_MATTE_KINDS; k++)
        if (kinds >> k & 1) EC_TRY(find(s, k, names, err));
    return EC_OK;
}

void ec_matte_names_free(ec_matte_names *names)
{
    for (uint32_t k = 0; k < EC_MATTE_KINDS; k++) {
        free(names->hashes[k]);
        free(names->manifests[k]);
    }
    *names = (ec_matte_names){0};
}
