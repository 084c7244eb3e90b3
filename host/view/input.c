#include "view/input.h"

#include <math.h>
#include <string.h>

#include "view/lists.h"
#include "view/orbit.h"

static const double half_turn = 3.14159265358979323846;

static const eclat_viewpoint *scene_camera(const ec_view_input *in)
{
    const eclat_facts *f = &in->facts;
    return &f->cameras[in->view.camera < 0 ? f->camera : (uint32_t)in->view.camera];
}

/* Keeps the camera where it was, even if it was not moved, whatever the file says now. */
void ec_view_input_learn(ec_view_input *in, const eclat_facts *facts)
{
    eclat_view_request *w = &in->view;
    bool is_first = in->facts.serial == 0, is_there = w->camera < (int32_t)facts->camera_count;
    in->facts = *facts;
    if (!is_there) w->camera = 0;
    if (is_first && !w->is_moved) w->viewpoint = *scene_camera(in);
    if (!is_there || memcmp(&w->viewpoint, scene_camera(in), sizeof w->viewpoint)) w->is_moved = true;
    in->selected.node = -1;
}

/* Returns the viewpoint; from here on the camera is the window's own. */
static eclat_viewpoint *take_camera(ec_view_input *in)
{
    eclat_view_request *w = &in->view;
    if (!w->is_moved) ec_orbit_settle(&w->viewpoint);
    return &w->viewpoint;
}

static void moved(ec_view_input *in) { in->view.is_moved = in->view.is_moving = in->moved = true; }

/* Multiplies the distance, within limits relative to the scene's radius where floats can tell eye and target apart, and the scene from a point; from
 * beyond them it only moves back. */
static void dolly(ec_view_input *in, double factor)
{
    const double least = 1e-6 * in->facts.radius, most = 1e4 * in->facts.radius;
    eclat_viewpoint *v = take_camera(in);
    double now = v->fov > 0 ? ec_orbit_distance(v) : v->tall, wanted = now * factor;
    if (wanted < least) wanted = fmin(least, now);
    if (wanted > most) wanted = fmax(most, now);
    ec_orbit_dolly(v, wanted / now);
}

static void frame(ec_view_input *in)
{
    const eclat_probe *node = in->selected.node >= 0 ? &in->selected : &in->under;
    bool some = node->node >= 0 && node->radius > 0;
    ec_orbit_frame(take_camera(in), some ? node->center : in->facts.center, some ? node->radius : in->facts.radius,
                   (double)in->view.width / in->view.height);
    moved(in);
}

static void show_camera(ec_view_input *in, int32_t camera)
{
    in->view.is_moved = false;
    in->view.camera = camera;
    in->view.viewpoint = *scene_camera(in);
}

static void reset(ec_view_input *in)
{
    eclat_view_request *w = &in->view;
    show_camera(in, -1);
    w->exposure = in->first.exposure;
    w->tonemap = in->first.tonemap;
    w->env_degrees = in->first.env_degrees;
    in->selected.node = -1;
}

static void next_camera(ec_view_input *in)
{
    uint32_t shown = in->view.camera < 0 ? in->facts.camera : (uint32_t)in->view.camera;
    show_camera(in, in->view.is_moved ? in->view.camera : (int32_t)((shown + 1) % in->facts.camera_count));
}

static void next_second(ec_view_input *in)
{
    const eclat_second last = in->has_file ? ECLAT_SECOND_FILE : ECLAT_SECOND_INTEGRATOR;
    if (in->layout == EC_LAYOUT_ONE) in->layout = EC_LAYOUT_WIPE;
    else in->second = in->second == last ? ECLAT_SECOND_ERROR : (eclat_second)(in->second + 1);
}

static void turn_environment(ec_view_input *in, double degrees)
{
    if (in->facts.has_map) in->view.env_degrees = fmod(in->view.env_degrees + degrees, 360);
}

void ec_view_input_do(ec_view_input *in, ec_view_action action)
{
    eclat_view_request *w = &in->view;
    bool of_scene = action == EC_DO_CAMERA || action == EC_DO_FRAME || action == EC_DO_RESET;
    if (of_scene && !in->facts.serial) return; /* the scene is being loaded; other actions apply to it once it is shown */
    switch (action) {
    case EC_DO_NOTHING: break;
    case EC_DO_HELP: in->help = !in->help, in->effects = false; break;
    case EC_DO_INTEGRATOR_PATH:
    case EC_DO_INTEGRATOR_WHITTED:
    case EC_DO_INTEGRATOR_RASTER:
    case EC_DO_INTEGRATOR_LIGHT: w->integrator = (eclat_integrator)(action - EC_DO_INTEGRATOR_PATH); break;
    case EC_DO_BRIGHTER: w->exposure = round(3 * w->exposure + 1) / 3; break;
    case EC_DO_DARKER: w->exposure = round(3 * w->exposure - 1) / 3; break;
    case EC_DO_TONEMAP: w->tonemap = (eclat_tonemap)((w->tonemap + 1) % ECLAT_TONEMAP_COUNT); break;
    case EC_DO_ENV_LEFT: turn_environment(in, -5); break;
    case EC_DO_ENV_RIGHT: turn_environment(in, 5); break;
    case EC_DO_CAMERA: next_camera(in); break;
    case EC_DO_FRAME: frame(in); break;
    case EC_DO_RESET: reset(in); break;
    case EC_DO_SECOND: next_second(in); break;
    case EC_DO_LAYOUT: in->layout = (ec_view_layout)((in->layout + 1) % EC_LAYOUT_COUNT); break;
    case EC_DO_RUNG: w->second_integrator = (eclat_integrator)((w->second_integrator + 1) % ECLAT_INTEGRATOR_COUNT); break;
    case EC_DO_LINES: in->lines = (ec_view_lines)((in->lines + 1) % EC_LINES_COUNT); break;
    case EC_DO_EFFECTS: in->effects = !in->effects, in->effects_page = 0, in->help = false; break;
    case EC_DO_MORE: w->more++; break;
    case EC_DO_DENOISE: w->is_denoised = !w->is_denoised; break;
    case EC_DO_SAVE: in->saves = eclat_live_save(in->live, w); break;
    case EC_DO_RELOAD: w->reloads++; break;
    case EC_DO_FULLSCREEN: in->fullscreen = !in->fullscreen; break;
    case EC_DO_QUIT: in->quit = true; break;
    }
    w->second = in->layout != EC_LAYOUT_ONE ? in->second : ECLAT_SECOND_NONE;
}

void ec_view_input_drag(ec_view_input *in, ec_view_drag drag, double dx, double dy)
{
    eclat_viewpoint *v = take_camera(in);
    switch (drag) { /* the picture follows the mouse */
    case EC_DRAG_ORBIT: ec_orbit_turn(v, -half_turn * dx, half_turn * dy); break;
    case EC_DRAG_PAN: ec_orbit_pan(v, -dx, dy); break;
    case EC_DRAG_DOLLY: dolly(in, exp(3 * dy)); break;
    case EC_DRAG_LOOK: ec_orbit_look(v, half_turn / 2 * dx, -half_turn / 2 * dy); break;
    }
    moved(in);
}

void ec_view_input_fly(ec_view_input *in, double forward, double right, double up, double seconds)
{
    double step = 0.5 * in->facts.radius * seconds;
    ec_orbit_fly(take_camera(in), forward * step, right * step, up * step);
    moved(in);
}

static bool is_digit(const char *name)
{
    return name[0] >= '0' && name[0] <= '9' && !name[1];
}

bool ec_view_input_knows(const char *name)
{
    return is_digit(name) || ec_view_action_of(name) != EC_DO_NOTHING;
}

void ec_view_input_key(ec_view_input *in, const char *name)
{
    const eclat_effect *effect = in->effects && is_digit(name) ? ec_view_effect_of_digit(&in->facts, in->effects_page, name[0] - '0') : NULL;
    if (!in->effects || !is_digit(name)) ec_view_input_do(in, ec_view_action_of(name));
    else if (name[0] == '0') in->effects_page++;
    else if (effect) in->view.without ^= effect->bit;
}
