/* --eye, --look-at, --up, --fov, --parallel: a camera of the command line, or one of the scene's with something changed. */
#ifndef EC_JOBS_CAMERA_CHANGE_H
#define EC_JOBS_CAMERA_CHANGE_H

#include <stdbool.h>

#include "scene/scene.h"

typedef struct ec_camera_change {
    bool has_eye, has_target, has_up, has_lens; /* lens: fov or tall */
    ec_viewpoint to;                            /* what was given */
} ec_camera_change;

/* Changes that camera of the scene; none asked for: nothing. What is not given stays, but for what the help says. *viewpoint: where it
 * stands then, in the very numbers that were given. */
ec_result ec_camera_change_apply(const ec_camera_change *change, ec_scene *scene, uint32_t camera,
                                 ec_viewpoint *viewpoint, ec_error *err);

#endif
