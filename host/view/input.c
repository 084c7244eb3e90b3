#include "view/input.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "view/lists.h"
#include "view/orbit.h"

static const double half_turn = 3.14159265358979323846;

void ec_view_input_learn(ec_view_input *in, const ec_view_facts *facts)
{
    bool first = in->facts.serial == 0;
    in->facts = *facts;
    if (first) in->wish.camera = in->asked.camera = facts->camera;
    if (in->wish.camera >= facts->camera_count) in->wish.camera = 0;
    if (!in->wish.moved) in->wish.viewpoint = facts->cameras[in->wish.camera];
    in->selected.node = -1;
}

/* From here on the camera is the window's own. */
static ec_viewpoint *take_camera(ec_view_input *in)
{
    ec_view_wish *w = &in->wish;
    if (!w->moved) w->viewpoint = in->facts.cameras[w->camera], ec_orbit_settle(&w->viewpoint);
    return &w->viewpoint;
}

static void moved(ec_view_input *in)
{
    ec_orbit_round(&in->wish.viewpoint);
    in->wish.moved = in->wish.moving = true;
    in->moved_at = ec_now();
}

/* In radii of the scene, as far as floats tell eye and target apart and the scene from a point; from beyond it goes only back. */
static void dolly(ec_view_input *in, double factor)
{
    const double least = 1e-6 * in->facts.radius, most = 1e4 * in->facts.radius;
    ec_viewpoint *v = take_camera(in);
    double now = v->fov > 0 ? ec_orbit_distance(v) : v->tall, wanted = now * factor;
    if (wanted < least) wanted = fmin(least, now);
    if (wanted > most) wanted = fmax(most, now);
    ec_orbit_dolly(v, wanted / now);
}

static void frame(ec_view_input *in)
{
    const ec_view_probe *node = in->selected.node >= 0 ? &in->selected : &in->under;
    bool some = node->node >= 0 && node->radius > 0;
    ec_orbit_frame(take_camera(in), some ? node->center : in->facts.center, some ? node->radius : in->facts.radius,
                   (double)in->wish.width / in->wish.height);
    moved(in);
}

static void reset(ec_view_input *in)
{
    ec_view_wish *w = &in->wish;
    w->moved = false;
    w->camera = in->facts.camera;
    w->viewpoint = in->facts.cameras[w->camera];
    w->exposure = in->request->exposure;
    w->tonemap = in->request->tonemap;
    w->env_degrees = in->request->env_degrees;
    in->selected.node = -1;
}

static void next_camera(ec_view_input *in)
{
    ec_view_wish *w = &in->wish;
    w->camera = w->moved ? w->camera : (w->camera + 1) % in->facts.camera_count;
    w->moved = false;
    w->viewpoint = in->facts.cameras[w->camera];
}

static void next_second(ec_view_input *in)
{
    uint32_t count = in->request->against ? EC_SECOND_COUNT : EC_SECOND_FILE;
    if (in->layout == EC_LAYOUT_ONE) in->layout = EC_LAYOUT_WIPE;
    else in->wish.second = (ec_view_second)((in->wish.second + 1) % count);
}

static void turn_environment(ec_view_input *in, double degrees)
{
    if (in->facts.has_map) in->wish.env_degrees = fmod(in->wish.env_degrees + degrees, 360);
}

void ec_view_input_do(ec_view_input *in, ec_view_action action)
{
    ec_view_wish *w = &in->wish;
    bool of_scene = action == EC_DO_CAMERA || action == EC_DO_FRAME || action == EC_DO_RESET;
    if (of_scene && !in->facts.serial) return; /* it is being loaded; all else is for it to be seen so */
    switch (action) {
    case EC_DO_NOTHING: break;
    case EC_DO_HELP: in->help = !in->help, in->effects = false; break;
    case EC_DO_INTEGRATOR_PATH:
    case EC_DO_INTEGRATOR_WHITTED:
    case EC_DO_INTEGRATOR_RASTER: w->integrator = (ec_integrator)(action - EC_DO_INTEGRATOR_PATH); break;
    case EC_DO_BRIGHTER: w->exposure = fmin(round(3 * w->exposure + 1) / 3, EC_EXPOSURE_MOST); break;
    case EC_DO_DARKER: w->exposure = fmax(round(3 * w->exposure - 1) / 3, -EC_EXPOSURE_MOST); break;
    case EC_DO_TONEMAP: w->tonemap = w->tonemap == EC_TONEMAP_NEUTRAL ? EC_TONEMAP_NONE : EC_TONEMAP_NEUTRAL; break;
    case EC_DO_ENV_LEFT: turn_environment(in, -5); break;
    case EC_DO_ENV_RIGHT: turn_environment(in, 5); break;
    case EC_DO_CAMERA: next_camera(in); break;
    case EC_DO_FRAME: frame(in); break;
    case EC_DO_RESET: reset(in); break;
    case EC_DO_SECOND: next_second(in); break;
    case EC_DO_LAYOUT: in->layout = (ec_view_layout)((in->layout + 1) % EC_LAYOUT_COUNT); break;
    case EC_DO_RUNG: w->rung = (ec_integrator)((w->rung + 1) % EC_INTEGRATOR_COUNT); break;
    case EC_DO_LINES: in->lines = (ec_view_lines)((in->lines + 1) % EC_LINES_COUNT); break;
    case EC_DO_EFFECTS: in->effects = !in->effects, in->effects_page = 0, in->help = false; break;
    case EC_DO_MORE: w->more++; break;
    case EC_DO_SAVE: w->saves++, in->asked = *w; break;
    case EC_DO_RELOAD: w->reloads++; break;
    case EC_DO_FULLSCREEN: in->fullscreen = !in->fullscreen; break;
    case EC_DO_QUIT: in->quit = true; break;
    }
    w->has_second = in->layout != EC_LAYOUT_ONE;
}

void ec_view_input_turn(ec_view_input *in, double yaw, double pitch)
{
    ec_orbit_turn(take_camera(in), yaw, pitch);
    moved(in);
}

void ec_view_input_drag(ec_view_input *in, ec_view_drag drag, double dx, double dy)
{
    ec_viewpoint *v = take_camera(in);
    switch (drag) { /* what is under the hand follows it */
    case EC_DRAG_ORBIT: ec_orbit_turn(v, -half_turn * dx, half_turn * dy); break;
    case EC_DRAG_PAN: ec_orbit_pan(v, -dx, dy); break;
    case EC_DRAG_DOLLY: dolly(in, exp(3 * dy)); break;
    case EC_DRAG_LOOK: ec_orbit_look(v, half_turn / 2 * dx, -half_turn / 2 * dy); break;
    }
    moved(in);
}

void ec_view_input_wheel(ec_view_input *in, double clicks)
{
    dolly(in, pow(0.9, clicks));
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
    if (!in->effects || !is_digit(name)) ec_view_input_do(in, ec_view_action_of(name));
    else if (name[0] == '0') in->effects_page++;
    else in->wish.without ^= ec_view_effect_of_digit(&in->facts, in->effects_page, name[0] - '0');
}
