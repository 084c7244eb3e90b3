#include "jobs/backdrop.h"

#include "device/camera.h"
#include "scene/blur.h"

/* Sets the directions of the kernels' rays through the middles of pixels: forward + x right + y up. */
static void look_through(const ec_camera *c, const ec_render_options *o, ec_behind *behind)
{
    const bool is_flat = c->type == EC_CAMERA_ORTHOGRAPHIC, is_part = ec_has_screen_window(o);
    const double whole[] = {-1, 1, -1, 1}, *window = is_part ? o->screen_window : whole;
    const double step[] = {(window[1] - window[0]) / o->width, (window[2] - window[3]) / o->height};
    double half[2];
    ec_camera_half_sizes(c, o, half);
    for (int k = 0; k < 3; k++) {
        behind->across[k] = is_flat ? 0 : c->right[k] * half[0] * step[0];
        behind->down[k] = is_flat ? 0 : c->up[k] * half[1] * step[1];
        behind->corner[k] = c->forward[k] + 0.5 * (behind->across[k] + behind->down[k]);
        if (!is_flat) behind->corner[k] += c->right[k] * half[0] * window[0] + c->up[k] * half[1] * window[3];
    }
}

ec_result ec_backdrop_make(const ec_scene *scene, const ec_render_options *o, double degrees, ec_behind *behind, ec_error *err)
{
    const ec_environment *e = &scene->environment;
    ec_made_map map = {0};
    if (scene->has_environment) EC_TRY(ec_environment_blur(e, degrees, &map, err));
    *behind = (ec_behind){.rgb = map.rgb, .width = map.width, .height = map.height};
    for (int k = 0; k < 9; k++) behind->turn[k] = e->turned ? e->turn[k] : k % 4 == 0;
    look_through(&scene->cameras[o->camera], o, behind);
    return EC_OK;
}
