#include "jobs/job_camera.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/vec3.h"
#include "jobs/defaults.h"
#include "jobs/numbers.h"
#include "report/scene_report.h"

/* Chooses the size without --size: the given height, and the width that fits the camera. */
static void choose_size(ec_render_options *options, uint32_t height, const ec_camera *camera)
{
    double aspect = camera->aspect;
    if (!(aspect > 0) && camera->type == EC_CAMERA_ORTHOGRAPHIC && camera->ymag > 0)
        aspect = fabs((double)camera->xmag / camera->ymag);
    if (!(aspect > 0)) aspect = 1;
    if (ec_has_screen_window(options))
        aspect = (options->screen_window[1] - options->screen_window[0]) / (options->screen_window[3] - options->screen_window[2]);
    options->height = height ? height : EC_DEFAULT_HEIGHT;
    options->width = (uint32_t)fmin(fmax(round(options->height * aspect), 1), EC_SIZE_MAX_SIDE);
}

/* Changes the camera if an option asks for it. Options that are not given keep its values, except as help says. *v: its viewpoint afterwards, in
 * exactly the numbers that were given. */
static ec_result change_camera(const ec_camera_change *change, ec_scene *s, uint32_t index, ec_viewpoint *v, ec_error *err)
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

/* Rotates about an axis through a point (Rodrigues 1840). */
static void turn(double p[3], const double axis[3], const double through[3], double angle)
{
    double from[3], across[3];
    for (int k = 0; k < 3; k++) from[k] = p[k] - through[k];
    ec_cross(axis, from, across);
    const double along = ec_dot(axis, from) * (1 - cos(angle));
    for (int k = 0; k < 3; k++) p[k] = through[k] + from[k] * cos(angle) + across[k] * sin(angle) + axis[k] * along;
}

/* Turns the camera around the scene by the request's angle. */
static ec_result turn_camera(const ec_render_request *r, ec_scene *s, uint32_t index, ec_viewpoint *v, ec_error *err)
{
    ec_camera *camera = &s->cameras[index], turned;
    double axis[3] = {0, 1, 0}, centre[3], origin[3] = {0};
    if (r->turn == 0) return EC_OK;
    for (int k = 0; k < 3; k++) {
        centre[k] = r->look.has_target ? r->look.to.target[k] : 0.5 * ((double)s->bounds_min[k] + s->bounds_max[k]) + s->center[k];
        if (r->look.has_up) axis[k] = r->look.to.up[k];
    }
    const double angle = r->turn * 3.14159265358979323846 / 180;
    ec_normalize(axis);
    turn(v->eye, axis, centre, angle);
    turn(v->target, axis, centre, angle);
    turn(v->up, axis, origin, angle);
    EC_TRY(ec_camera_look(v, s->center, &turned, err));
    turned.aspect = camera->aspect;
    turned.xmag = camera->xmag;
    turned.name = camera->name;
    *camera = turned;
    return EC_OK;
}

ec_result ec_job_camera(ec_render_job *job, ec_error *err)
{
    ec_render_options *options = &job->request->options;
    options->camera = job->scene->default_camera;
    if (job->request->camera) EC_TRY(ec_scene_find_camera(job->scene, job->request->camera, &options->camera, err));
    EC_TRY(change_camera(&job->request->look, job->scene, options->camera, &job->viewpoint, err));
    EC_TRY(turn_camera(job->request, job->scene, options->camera, &job->viewpoint, err));
    if (!job->request->has_size) choose_size(options, job->request->default_height, &job->scene->cameras[options->camera]);
    ec_camera_describe(job->scene, options->camera, job->camera_text, sizeof job->camera_text);
    return EC_OK;
}
