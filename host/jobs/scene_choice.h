/* --scene, --variant, --animation and --at, for every command that reads a scene. After setters.h; `field` is where in REQUEST the
 * ec_scene_choice lies. */
#ifndef EC_JOBS_SCENE_CHOICE_H
#define EC_JOBS_SCENE_CHOICE_H

#include "jobs/setters.h"

#define EC_MOMENT_MOST 1e9 /* seconds */

#define SCENE_CHOICE_SETTERS(field)                                                          \
    TEXT_SETTER(scene, field.scene)                                                          \
    TEXT_SETTER(variant, field.variant)                                                      \
    SETTER(animation)                                                                        \
    {                                                                                        \
        if (!*value) return ec_usage(err, "option '--%s' needs a value that is not empty", option); \
        REQUEST->field.animation = value;                                                    \
        REQUEST->field.animated = true;                                                      \
        return EC_OK;                                                                        \
    }                                                                                        \
    SETTER(at)                                                                               \
    {                                                                                        \
        REQUEST->field.animated = REQUEST->field.at_given = true;                            \
        return ec_parse_real(option, value, 0, EC_MOMENT_MOST, &REQUEST->field.at, err);     \
    }

#define SCENE_CHOICE_OPTIONS                                                                 \
    {"animation", 0, true, set_animation}, {"at", 0, true, set_at}, {"scene", 0, true, set_scene}, {"variant", 0, true, set_variant}

/* --shutter, for those that blur or count what that takes; in their checks SHUTTER_CHECK. */
#define SHUTTER_SETTER(field)                                                                \
    SETTER(shutter)                                                                          \
    {                                                                                        \
        REQUEST->field.shutter = true;                                                       \
        return ec_parse_span(option, value, EC_MOMENT_MOST, &REQUEST->field.opens, &REQUEST->field.closes, err); \
    }
#define SHUTTER_OPTION {"shutter", 0, true, set_shutter}

#endif
