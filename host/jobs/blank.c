#include "jobs/blank.h"

#include "device/camera.h"
#include "scene/in_sight.h"

static void find_window(const ec_camera *c, const ec_render_options *o, double window[4])
{
    const double whole[4] = {-1, 1, -1, 1}, *shown = ec_has_screen_window(o) ? o->screen_window : whole;
    double half[2];
    ec_camera_half_sizes(c, o, half);
    for (int k = 0; k < 4; k++) window[k] = shown[k] * half[k / 2];
}

static bool is_within(const ec_scene *s, const float point[3])
{
    for (int k = 0; k < 3; k++)
        if (point[k] < s->bounds_min[k] || point[k] > s->bounds_max[k]) return false;
    return true;
}

bool ec_warn_of_blank(const ec_render_job *job)
{
    const ec_scene *s = job->scene;
    const ec_render_options *o = &job->request->options;
    const ec_camera *camera = &s->cameras[o->camera];
    double window[4];
    if (!s->triangle_count || o->fstop > 0 || (o->without & EC_FEATURE_CULLING)) return false; /* no triangles: reported on reading */
    find_window(camera, o, window);
    const ec_in_sight seen = ec_scene_in_sight(s, camera, window);
    if (seen == EC_SIGHT_FRONTS) return false;
    const char *inside = is_within(s, camera->position) ? ", from within the scene" : "";
    if (seen == EC_SIGHT_NONE)
        ec_warn(&job->listener->log, "the picture will show no surface: there is none in the view of camera %s%s; --eye and --look-at place it elsewhere",
                job->camera_text, inside);
    else
        ec_warn(&job->listener->log, "the picture will show no surface: camera %s sees nothing but backs of single-sided materials%s, which its rays pass "
                "through; look from the other side (--eye), make the materials double-sided, or leave culling out with --without back-face-culling",
                job->camera_text, inside);
    return true;
}
