#include "scene/light_groups.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

/* Something that gives light: the environment, a light, a material. */
typedef struct source {
    char name[EC_GROUP_NAME];
    uint32_t *group;
} source;

typedef struct finder {
    source *sources;
    uint32_t count;
    char names[EC_GROUPS_MOST][EC_GROUP_NAME]; /* of groups, in the order of their creation */
    uint32_t groups;
} finder;

enum { NONE = UINT32_MAX };

/* Makes a name that channels can have: in EXR files, a dot ends the name of a layer. */
static void name_source(source *s, const char *name, const char *kind, uint32_t number, uint32_t *group)
{
    *group = NONE;
    s->group = group;
    if (name && *name) snprintf(s->name, sizeof s->name, "%.*s", EC_CUT(name, EC_GROUP_NAME - 1));
    else snprintf(s->name, sizeof s->name, "%s%u", kind, number);
    for (char *c = s->name; *c; c++)
        if (!isalnum((unsigned char)*c) && *c != '-' && !((unsigned char)*c & 0x80)) *c = '_';
}

static bool shines(const ec_scene *scene, uint32_t material)
{
    const ec_material *m = &scene->materials[material];
    if (!ec_emits(m) && !m->unlit) return false;
    for (uint32_t i = 0; i < scene->triangle_count; i++)
        if (scene->triangle_material[i] == material) return true;
    return false;
}

static void list_sources(const ec_scene *scene, ec_light_groups *g, finder *f)
{
    if (scene->has_environment) name_source(&f->sources[f->count++], "environment", NULL, 0, &g->environment);
    for (uint32_t i = 0; i < scene->light_count; i++) name_source(&f->sources[f->count++], scene->lights[i].name, "light", i, &g->of_light[i]);
    for (uint32_t i = 0; i < scene->material_count; i++)
        if (shines(scene, i)) name_source(&f->sources[f->count++], scene->materials[i].name, "material", i, &g->of_material[i]);
}

/* Returns the group of that name, a new one if needed; NONE: there are too many. */
static uint32_t group_of(finder *f, const char *name)
{
    for (uint32_t k = 0; k < f->groups; k++)
        if (!strcmp(f->names[k], name)) return k;
    if (f->groups == EC_GROUPS_MOST) return NONE;
    snprintf(f->names[f->groups], EC_GROUP_NAME, "%s", name);
    return f->groups++;
}

static ec_result refuse_name(const finder *f, const char *name, ec_error *err)
{
    char all[400] = "";
    for (uint32_t i = 0; i < f->count && strlen(all) + EC_GROUP_NAME + 2 < sizeof all; i++)
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s", i ? ", " : "", f->sources[i].name);
    return ec_fail(err, "--light-groups: the scene has no light '%s'; there is %s", name, f->count ? all : "none");
}

static ec_result too_many(ec_error *err)
{
    return ec_fail(err, "--light-groups: there can be at most %d groups; put several lights into one, as in key=lamp+sun", EC_GROUPS_MOST);
}

/* Puts all sources of one name into a group. */
static ec_result take(finder *f, const char *name, uint32_t group, ec_error *err)
{
    bool any = false;
    for (uint32_t i = 0; i < f->count; i++) {
        if (strcmp(f->sources[i].name, name)) continue;
        if (*f->sources[i].group != NONE) return ec_fail(err, "--light-groups: '%s' is in two groups; name it once", name);
        any = true;
    }
    for (uint32_t i = 0; i < f->count; i++)
        if (!strcmp(f->sources[i].name, name)) *f->sources[i].group = group;
    return any ? EC_OK : refuse_name(f, name, err);
}

/* Takes GROUP=NAME+NAME, or a NAME. */
static ec_result take_entry(finder *f, const char *text, size_t size, ec_error *err)
{
    char entry[1024], name[EC_GROUP_NAME];
    snprintf(entry, sizeof entry, "%.*s", (int)(size < sizeof entry ? size : sizeof entry - 1), text);
    char *names = strchr(entry, '=');
    if (names) *names++ = 0;
    source named;
    uint32_t unused;
    name_source(&named, entry, "", 0, &unused);
    if (!*entry || (names && !*names)) return ec_fail(err, "--light-groups: '%.80s' has an empty name; give NAME,NAME,… or GROUP=NAME+NAME,…", text);
    const uint32_t group = group_of(f, named.name);
    if (group == NONE) return too_many(err);
    for (const char *word = names ? names : entry;; word++) {
        const size_t length = strcspn(word, "+");
        snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1), word);
        name_source(&named, name, "", 0, &unused);
        EC_TRY(take(f, named.name, group, err));
        word += length;
        if (!*word) return EC_OK;
    }
}

static void take_all(finder *f)
{
    for (uint32_t i = 0; i < f->count; i++) {
        const bool is_last = f->groups + 1 == EC_GROUPS_MOST && i + 1 < f->count; /* reserves one for the rest */
        if (*f->sources[i].group == NONE) *f->sources[i].group = group_of(f, is_last ? "rest" : f->sources[i].name);
    }
}

static ec_result take_list(finder *f, const char *list, ec_error *err)
{
    for (const char *word = list;; word++) {
        const size_t size = strcspn(word, ",");
        EC_TRY(take_entry(f, word, size, err));
        word += size;
        if (!*word) break;
    }
    for (uint32_t i = 0; i < f->count; i++) {
        if (*f->sources[i].group != NONE) continue;
        if ((*f->sources[i].group = group_of(f, "rest")) == NONE) return too_many(err);
    }
    return EC_OK;
}

static int compare_names(const void *a, const void *b) { return strcmp(a, b); }

/* Sorts the groups by name; what gives no light is assigned to the first. */
static void settle(finder *f, const ec_scene *scene, ec_light_groups *g)
{
    uint32_t place[EC_GROUPS_MOST];
    g->count = f->groups;
    memcpy(g->names, f->names, sizeof g->names);
    qsort(g->names, f->groups, sizeof g->names[0], compare_names);
    for (uint32_t k = 0; k < f->groups; k++)
        place[k] = (uint32_t)((char (*)[EC_GROUP_NAME])bsearch(f->names[k], g->names, f->groups, EC_GROUP_NAME, compare_names) - g->names);
    for (uint32_t i = 0; i < f->count; i++) *f->sources[i].group = place[*f->sources[i].group];
    for (uint32_t i = 0; i < scene->material_count; i++)
        if (g->of_material[i] == NONE) g->of_material[i] = 0;
    if (g->environment == NONE) g->environment = 0;
}

ec_result ec_light_groups_find(const ec_scene *scene, const char *list, ec_light_groups *g, ec_error *err)
{
    finder f = {.count = 0};
    *g = (ec_light_groups){.environment = NONE};
    g->of_light = calloc(scene->light_count + 1, sizeof *g->of_light);
    g->of_material = malloc((scene->material_count + 1) * sizeof *g->of_material);
    f.sources = calloc(1 + scene->light_count + scene->material_count, sizeof *f.sources);
    ec_result result = g->of_light && g->of_material && f.sources ? EC_OK : ec_fail(err, "out of memory for light groups");
    for (uint32_t i = 0; result == EC_OK && i < scene->material_count; i++) g->of_material[i] = NONE;
    if (result == EC_OK) list_sources(scene, g, &f);
    if (result == EC_OK && !f.count) result = ec_fail(err, "--light-groups: the scene has no light; leave it out");
    if (result == EC_OK && !strcmp(list, "all")) take_all(&f);
    else if (result == EC_OK) result = take_list(&f, list, err);
    if (result == EC_OK) settle(&f, scene, g);
    else ec_light_groups_free(g);
    free(f.sources);
    return result;
}

void ec_light_groups_free(ec_light_groups *g)
{
    free(g->of_light);
    free(g->of_material);
    *g = (ec_light_groups){0};
}
