#include "jobs/camera_change.h"

#include <stdlib.h>
#include <string.h>

ec_result ec_camera_change_apply(const ec_camera_change *change, ec_scene *s, uint32_t index, ec_viewpoint *v, ec_error *err)
{
    ec_camera *camera = &s->cameras[index], changed;
    bool moves = change->has_eye || change->has_target;
    ec_camera_viewpoint(camera, s->center, ec_camera_reach(s, camera), v);
    if (!moves && !change->has_up && !change->has_lens) return EC_OK;
    for (int k = 0; k < 3; k++) {
        if (change->has_eye) v->target[k] = 0.5 * ((double)s->bounds_min[k] + s->bounds_max[k]) + s->center[k];
        if (change->has_eye) v->eye[k] = change->to.eye[k];
        if (change->has_target) v->target[k] = change->to.target[k];
        if (moves) v->up[k] = k == 1;
        if (change->has_up) v->up[k] = change->to.up[k];
    }
    if (change->has_lens) v->fov = change->to.fov, v->tall = change->to.tall;
    EC_TRY(ec_camera_look(v, s->center, &changed, err));
    changed.aspect = camera->aspect;
    free(camera->name);
    *camera = changed;
    camera->name = strdup("command line");
    return EC_OK;
}
