/* Tells whether anything in a scene emits light. */
#ifndef EC_TESTS_SUPPORT_LIGHT_H
#define EC_TESTS_SUPPORT_LIGHT_H

#include "pack/pack.h"
#include "support/test.h"

static inline bool has_light(const ec_scene *scene)
{
    ec_scene_light found = {0};
    ec_error err;
    CHECK_OK(ec_scene_find_light(scene, &found, &err), err);
    return found.any;
}

#endif
