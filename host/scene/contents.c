/* Lists of names to choose from: scenes, variants, animations, cameras. */
#include "base/text.h"
#include "scene/scene.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void free_names(ec_scene_names *list)
{
    for (uint32_t i = 0; list->names && i < list->count; i++) free(list->names[i]);
    free(list->names);
}

void ec_scene_contents_free(ec_scene_contents *contents)
{
    free_names(&contents->scenes);
    free_names(&contents->variants);
    free_names(&contents->animations);
    free_names(&contents->extensions);
    free_names(&contents->ignored);
    free(contents->seconds);
    *contents = (ec_scene_contents){0};
}

static ec_result fail_listing(const ec_scene_names *list, const char *what, const char *wanted, ec_error *err)
{
    char text[1024] = "";
    for (uint32_t i = 0; i < list->count; i++) {
        char item[160];
        const char *name = list->names[i];
        int used = snprintf(item, sizeof item, "%s%u", i ? ", " : "", i);
        if (name) snprintf(item + used, sizeof item - (size_t)used, " \"%.*s\"", EC_CUT(name, 100));
        if (strlen(text) + strlen(item) + 5 > sizeof text) {
            strcat(text, " ...");
            break;
        }
        strcat(text, item);
    }
    if (!list->count) return ec_fail(err, "there is no %s \"%.*s\"; the file has none", what, EC_CUT(wanted, 200));
    return ec_fail(err, "there is no %s \"%.*s\"; there are: %s", what, EC_CUT(wanted, 200), text);
}

ec_result ec_scene_names_find(const ec_scene_names *list, const char *what, const char *wanted, uint32_t *index, ec_error *err)
{
    for (uint32_t i = 0; i < list->count; i++) {
        if (!list->names[i] || strcmp(list->names[i], wanted) != 0) continue;
        *index = i;
        return EC_OK;
    }
    char *end;
    errno = 0;
    unsigned long number = strtoul(wanted, &end, 10);
    bool is_number = *wanted >= '0' && *wanted <= '9' && !*end && !errno;
    if (!is_number || number >= list->count) return fail_listing(list, what, wanted, err);
    *index = (uint32_t)number;
    return EC_OK;
}
