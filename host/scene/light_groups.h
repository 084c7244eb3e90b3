/* Which light of a scene is of which light group: lights by the names of their nodes, what shines by those of materials, and the environment. */
#ifndef EC_SCENE_LIGHT_GROUPS_H
#define EC_SCENE_LIGHT_GROUPS_H

#include "scene/scene.h"
#include "shared/params.h"

typedef struct ec_light_groups {
    uint32_t count;
    char names[EC_GROUPS_MOST][EC_GROUP_NAME]; /* in the order of the alphabet */
    uint32_t environment;            /* its group, from 0 on */
    uint32_t *of_light, *of_material; /* of each of the scene's; owned */
} ec_light_groups;

/* list: names with commas between them, each a group, GROUP=NAME+NAME for one of several, or "all" for a group of each; what is left over is in
 * the group "rest". Fails where no light has such a name (the message lists what
 * there is), or where there are more than EC_GROUPS_MOST groups; of "all" those that are too many are in the rest. */
ec_result ec_light_groups_find(const ec_scene *scene, const char *list, ec_light_groups *groups, ec_error *err);
void ec_light_groups_free(ec_light_groups *groups); /* zero-initialised is fine */

#endif
