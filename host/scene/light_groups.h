/* Assigns the lights of a scene to light groups: lights by names of their nodes, emissive materials by their own, and the environment. */
#ifndef EC_SCENE_LIGHT_GROUPS_H
#define EC_SCENE_LIGHT_GROUPS_H

#include "scene/scene.h"
#include "shared/params.h"

typedef struct ec_light_groups {
    uint32_t count;
    char names[EC_GROUPS_MOST][EC_GROUP_NAME]; /* in alphabetical order */
    uint32_t environment;            /* index of its group */
    uint32_t *of_light, *of_material; /* by light, by material: index of the group; owned */
} ec_light_groups;

/* list: names separated by commas, each a group, or GROUP=NAME+NAME for a group of several, or "all" for a group of each. Lights not listed are in
 * the group "rest". Fails if no light has such a name (the message lists those there are), or if there are more than EC_GROUPS_MOST groups; with
 * "all", those in excess are in the rest. */
ec_result ec_light_groups_find(const ec_scene *scene, const char *list, ec_light_groups *groups, ec_error *err);
void ec_light_groups_free(ec_light_groups *groups); /* zero-initialised is fine */

#endif
