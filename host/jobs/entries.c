#include "jobs/entries.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ec_result ec_entries_add(ec_entries *entries, const char *name, const char *scene, ec_entry **entry, ec_error *err)
{
    ec_entry *longer = realloc(entries->list, (entries->count + 1) * sizeof *longer);
    if (!longer) return ec_fail(err, "out of memory for '%s'", name);
    entries->list = longer;
    *entry = &longer[entries->count++];
    **entry = (ec_entry){.name = strdup(name), .scene = strdup(scene)};
    return (*entry)->name && (*entry)->scene ? EC_OK : ec_fail(err, "out of memory for '%s'", name);
}

void ec_entries_free(ec_entries *entries)
{
    for (uint32_t i = 0; i < entries->count; i++) {
        free(entries->list[i].name);
        free(entries->list[i].scene);
        free(entries->list[i].why_not);
        ec_given_free(&entries->list[i].given);
    }
    free(entries->list);
    *entries = (ec_entries){0};
}

ec_result ec_entries_check(const ec_given_options *given, ec_error *err)
{
    static const char *const alone[] = {"checkpoint", "plan", "resume", "samples", "snapshot"};
    for (size_t i = 0; i < sizeof alone / sizeof *alone; i++)
        if (ec_given_has(given, alone[i]))
            return ec_usage(err, "--%s works with a single picture, but several are given; leave --%s out: the same command, run again, skips pictures that exist",
                            alone[i], alone[i]);
    return EC_OK;
}

ec_result ec_entry_give(ec_entry *entry, const ec_given_options *given, ec_error *err)
{
    for (int i = 0; i < given->count; i++) {
        const ec_option *row = ec_render_row(given->list[i].option);
        if (row->group == EC_GROUP_SERIES || row->kind == EC_AS_OUTPUT) continue;
        EC_TRY(ec_given_add(&entry->given, row->name, given->list[i].value, err));
    }
    return EC_OK;
}

typedef struct place {
    const char *word, *from; /* what replaces the word */
    int length;
} place;

enum { PLACES = 2 };
static const char *const words[PLACES] = {"{name}", "{folder}"};

bool ec_entries_has_place(const char *output) { return strstr(output, words[0]) || strstr(output, words[1]); }

/* Finds the replacements: fox and models for "models/fox.glb". */
static void find_places(const char *scene, place places[PLACES])
{
    const char *slash = strrchr(scene, '/'), *name = slash ? slash + 1 : scene, *dot = strrchr(name, '.'), *folder = slash ? slash : scene;
    while (folder > scene && folder[-1] != '/') folder--;
    places[0] = (place){words[0], name, (int)(dot && dot != name ? (size_t)(dot - name) : strlen(name))};
    places[1] = (place){words[1], slash ? folder : ".", slash ? (int)(slash - folder) : 1};
}

static ec_result fill(const char *pattern, const place places[PLACES], char path[PATH_MAX], ec_error *err)
{
    size_t used = 0;
    while (*pattern) {
        const place *p = NULL;
        for (int i = 0; i < PLACES && !p; i++)
            if (!strncmp(pattern, places[i].word, strlen(places[i].word))) p = &places[i];
        const size_t length = p ? (size_t)p->length : 1;
        if (used + length >= PATH_MAX) return ec_usage(err, "-o: the path is longer than %d bytes", PATH_MAX - 1);
        memcpy(path + used, p ? p->from : pattern, length);
        used += length;
        pattern += p ? strlen(p->word) : 1;
    }
    path[used] = 0;
    return EC_OK;
}

static ec_result add_outputs(ec_entry *entry, const ec_given_options *given, bool several, ec_error *err)
{
    place places[PLACES];
    char path[PATH_MAX];
    find_places(entry->scene, places);
    for (int i = 0; i < given->count; i++) {
        const char *pattern = given->list[i].value;
        if (ec_render_row(given->list[i].option)->kind != EC_AS_OUTPUT) continue;
        if (several && !ec_entries_has_place(pattern))
            return ec_usage(err, "-o: '%s' is one name for all scenes; put {name} where the scene's name goes, as in 'thumbs/{name}.png'", pattern);
        EC_TRY(fill(pattern, places, path, err));
        EC_TRY(ec_given_add(&entry->given, "output", path, err));
    }
    return EC_OK;
}

/* Fails if several scenes would share an output, as happens easily: many a scene is called scene.gltf in a folder of its own. */
static ec_result check_alike(const ec_entries *entries, ec_error *err)
{
    for (uint32_t i = 1; i < entries->count; i++) {
        const ec_entry *a = &entries->list[i];
        place of_a[PLACES], of_b[PLACES];
        find_places(a->scene, of_a);
        for (uint32_t k = 0; k < i; k++) {
            const ec_entry *b = &entries->list[k];
            if (!strcmp(a->scene, b->scene)) return ec_usage(err, "'%s' is given twice; remove one", a->scene);
            find_places(b->scene, of_b);
            for (int o = 0; o < a->given.count; o++)
                if (!strcmp(a->given.list[o].option, "output") && !strcmp(a->given.list[o].value, b->given.list[o].value))
                    return ec_usage(err, "-o: '%s' and '%s' would both be written to '%s'; put {name} or {folder} into its name, to tell them apart", b->scene, a->scene,
                                    a->given.list[o].value);
            if (!ec_given_has(&a->given, "output") && of_a[0].length == of_b[0].length && !memcmp(of_a[0].from, of_b[0].from, (size_t)of_a[0].length))
                return ec_usage(err, "'%s' and '%s' would be written to the same files; give -o with {folder} in its name, as in '{folder}.png'", b->scene, a->scene);
        }
    }
    return EC_OK;
}

ec_result ec_entries_of_scenes(char *const *scenes, int count, const ec_given_options *given, ec_entries *entries, ec_error *err)
{
    EC_TRY(ec_entries_check(given, err));
    for (int i = 0; i < count; i++) {
        ec_entry *entry;
        EC_TRY(ec_entries_add(entries, scenes[i], scenes[i], &entry, err));
        EC_TRY(ec_entry_give(entry, given, err));
        EC_TRY(add_outputs(entry, given, count > 1, err));
    }
    return check_alike(entries, err);
}
