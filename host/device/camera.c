/* The camera's part of the kernels' parameters. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "device/camera.h"
#include "device/pipeline.h"

/* glTF says nothing of lenses. This one is in front of a sensor 24 mm high, that of small-picture film, so that its focal length follows from the
 * field of view. The focal length is that of focus at infinity whatever is in focus, and the field of view stays: a lens that is focused nearer would
 * show a little less. */
#define EC_SENSOR_HEIGHT 0.024

static ec_result set_lens(const ec_camera *c, const ec_render_options *o, ec_params *params, ec_error *err)
{
    if (o->fstop == 0) return EC_OK;
    if (c->type == EC_CAMERA_ORTHOGRAPHIC)
        return ec_fail(err, "camera %u is orthographic, so its rays do not meet in a lens; choose a perspective camera, or leave out --fstop and --focus",
                       o->camera);
    if (!(o->fstop > 0 && o->focus > 0)) return ec_fail(err, "a lens needs a positive fstop and a positive focus");
    double focal_length = EC_SENSOR_HEIGHT / (2 * tan(0.5 * c->yfov)), radius = focal_length / (2 * o->fstop);
    for (int k = 0; k < 3; k++) {
        params->lens_right[k] = (float)(c->right[k] * radius);
        params->lens_up[k] = (float)(c->up[k] * radius);
    }
    params->lens_nearness = (float)(1 / o->focus);
    return EC_OK;
}

void ec_camera_half_sizes(const ec_camera *c, const ec_render_options *o, double half[2])
{
    const double aspect = ec_has_screen_window(o) ? 1 : (double)o->width / o->height;
    const bool is_flat = c->type == EC_CAMERA_ORTHOGRAPHIC;
    half[1] = is_flat ? c->ymag : tan(0.5 * c->yfov);
    half[0] = is_flat && c->aspect <= 0.0f && c->xmag > 0.0f && !ec_has_screen_window(o) ? c->xmag : half[1] * aspect;
}

void ec_pipeline_set_view(const ec_camera *c, const ec_render_options *o, ec_params *params)
{
    const double *window = o->screen_window;
    double half[2];
    ec_camera_half_sizes(c, o, half);
    for (int k = 0; k < 3; k++) {
        params->camera_origin[k] = c->position[k];
        params->camera_right[k] = (float)(c->right[k] * half[0]);
        params->camera_up[k] = (float)(c->up[k] * half[1]);
        params->camera_forward[k] = c->forward[k];
    }
    params->orthographic = c->type == EC_CAMERA_ORTHOGRAPHIC;
    const float whole[] = {-1, 1, 2.0f / (float)o->width, -2.0f / (float)o->height};
    const float part[] = {(float)window[0], (float)window[3], (float)((window[1] - window[0]) / o->width), (float)((window[2] - window[3]) / o->height)};
    memcpy(params->screen, ec_has_screen_window(o) ? part : whole, sizeof whole);
    params->film_area = fabsf((float)(half[0] * half[1]) * params->screen[2] * params->screen[3]) * (float)o->width * (float)o->height;
}

ec_result ec_pipeline_set_camera(const ec_camera *c, const ec_render_options *o, ec_params *params, ec_error *err)
{
    ec_pipeline_set_view(c, o, params);
    return set_lens(c, o, params, err);
}

ec_result ec_payload_add_camera(ec_payload *payload, const ec_scene *scene, const ec_render_options *o, ec_error *err)
{
    const ec_motion *motion = &scene->motion;
    const size_t keys = motion->segments + 1;
    uint32_t moves = scene->cameras[o->camera].moves;
    if (!motion->segments || !moves) return EC_OK;
    float *table = calloc(keys * EC_CAMERA_VECTORS * 4, sizeof *table);
    if (!table) return ec_fail(err, "out of memory for a camera at %zu moments", keys);
    ec_payload_add(payload, EC_ARG_CAMERA_KEYS, "camera keys", keys * EC_CAMERA_VECTORS * 16, 0, table, table);
    for (size_t k = 0; k < keys; k++) {
        ec_params params = {.orthographic = 0};
        EC_TRY(ec_pipeline_set_camera(&motion->cameras[(moves - 1) * keys + k], o, &params, err));
        for (size_t v = 0; v < EC_CAMERA_VECTORS; v++)
            memcpy(table + (v * keys + k) * 4, (const float *)&params + 4 * v, 4 * sizeof *table);
    }
    return EC_OK;
}
