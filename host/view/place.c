/* Places the window: entirely on one monitor, or full screen on the monitor that has most of it, and back. Monitors may come and go. */
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>

#include "view/window.h"

#define SETTLES 1 /* seconds in which window managers rescue windows from a monitor that is gone, and Wayland tells a new window's density */

typedef ec_window_place place;

/* Counts changes of monitors, which GLFW reports to the process, not to a window. */
static unsigned monitor_changes;
static void on_monitor(GLFWmonitor *monitor, int event) { (void)monitor, (void)event, monitor_changes++; }

static place place_of(GLFWwindow *glfw)
{
    place p = {0}; /* under Wayland it is unknown */
    glfwGetWindowPos(glfw, &p.x, &p.y);
    glfwGetWindowSize(glfw, &p.width, &p.height);
    return p;
}

static place whole_of(GLFWmonitor *monitor)
{
    const GLFWvidmode *mode = glfwGetVideoMode(monitor);
    place p = {.width = mode ? mode->width : 0, .height = mode ? mode->height : 0};
    glfwGetMonitorPos(monitor, &p.x, &p.y);
    return p;
}

/* Returns the part of a monitor that panels and the window's frame leave free. */
static place room_of(GLFWmonitor *monitor, GLFWwindow *glfw)
{
    int left = 0, top = 0, right = 0, bottom = 0;
    place p;
    glfwGetMonitorWorkarea(monitor, &p.x, &p.y, &p.width, &p.height);
    glfwGetWindowFrameSize(glfw, &left, &top, &right, &bottom);
    return (place){p.x + left, p.y + top, p.width - left - right, p.height - top - bottom};
}

static double shared_area(const place *a, const place *b)
{
    double wide = fmin(a->x + a->width, b->x + b->width) - fmax(a->x, b->x),
           high = fmin(a->y + a->height, b->y + b->height) - fmax(a->y, b->y);
    return wide > 0 && high > 0 ? wide * high : 0;
}

/* Returns the monitor with most of a place, and *area, its share of it; the first one if none has any; NULL: there are no monitors. */
static GLFWmonitor *monitor_of(const place *p, double *area)
{
    int count;
    GLFWmonitor **monitors = glfwGetMonitors(&count), *best = count ? monitors[0] : NULL;
    *area = 0;
    for (int i = 0; i < count; i++) {
        place whole = whole_of(monitors[i]);
        double here = shared_area(p, &whole);
        if (here > *area) best = monitors[i], *area = here;
    }
    return best;
}

/* Moves a place into the room, and shrinks it in proportion if it is too large. */
static place put_into(const place *room, const place *p)
{
    double shrink = fmin(1, fmin((double)room->width / p->width, (double)room->height / p->height));
    place q = {.width = (int)fmax(round(p->width * shrink), 1), .height = (int)fmax(round(p->height * shrink), 1)};
    q.x = (int)fmax(fmin(p->x, room->x + room->width - q.width), room->x);
    q.y = (int)fmax(fmin(p->y, room->y + room->height - q.height), room->y);
    return q;
}

static void move_to(GLFWwindow *glfw, const place *from, const place *to)
{
    if (to->width != from->width || to->height != from->height) glfwSetWindowSize(glfw, to->width, to->height);
    if (to->x != from->x || to->y != from->y) glfwSetWindowPos(glfw, to->x, to->y);
}

/* Fills a monitor, in its current mode. */
static void fill(GLFWwindow *glfw, GLFWmonitor *monitor)
{
    const GLFWvidmode *mode = glfwGetVideoMode(monitor);
    if (mode) glfwSetWindowMonitor(glfw, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void ec_window_follow_monitors(ec_window *w)
{
    double area;
    bool changed = w->monitor_changes != monitor_changes;
    if (changed) w->monitors_settle = glfwGetTime() + SETTLES;
    else if (glfwGetTime() > w->monitors_settle) return;
    w->monitor_changes = monitor_changes;
    GLFWmonitor *monitor = glfwGetWindowMonitor(w->glfw);
    if (monitor && changed) fill(w->glfw, monitor); /* it may have moved */
    if (monitor) return;
    place now = place_of(w->glfw), wanted;
    if (changed || w->is_full) w->restores = w->is_full;
    if (w->is_full) w->is_full = w->input.fullscreen = false; /* GLFW has left full screen with the monitor */
    wanted = w->restores ? w->before : now; /* whatever window managers do to it meanwhile */
    monitor = monitor_of(&wanted, &area);
    if (!monitor) return;
    place room = room_of(monitor, w->glfw);
    if (area < 0.5 * wanted.width * wanted.height) wanted = put_into(&room, &wanted);
    move_to(w->glfw, &now, &wanted);
}

double ec_window_density(GLFWwindow *glfw)
{
    int width, height, across, down;
    glfwGetWindowSize(glfw, &width, &height);
    glfwGetFramebufferSize(glfw, &across, &down);
    return width > 0 && across > 0 ? (double)across / width : 1;
}

/* Sets the size that was asked for in pixels, as far as there is room. hidden: its position is left to the window manager. */
static void take_size(ec_window *w, bool hidden)
{
    double area, density = ec_window_density(w->glfw);
    place now = place_of(w->glfw), wanted = now;
    wanted.width = (int)fmax(round(w->asked_width / density), 1);
    wanted.height = (int)fmax(round(w->asked_height / density), 1);
    GLFWmonitor *monitor = hidden ? glfwGetPrimaryMonitor() : monitor_of(&wanted, &area);
    if (monitor) {
        place room = room_of(monitor, w->glfw);
        wanted = put_into(&room, &wanted);
    }
    if (hidden) wanted.x = now.x, wanted.y = now.y;
    move_to(w->glfw, &now, &wanted);
}

void ec_window_fit(ec_window *w, int width, int height)
{
    w->input.view.width = (uint32_t)fmin(fmax(width, 1), w->textures.largest); /* a larger window shows it stretched */
    w->input.view.height = (uint32_t)fmin(fmax(height, 1), w->textures.largest);
}

void ec_window_stand(ec_window *w, uint32_t width, uint32_t height)
{
    w->asked_width = width;
    w->asked_height = height;
    glfwSetMonitorCallback(on_monitor);
    w->monitor_changes = monitor_changes;
    take_size(w, true);
    glfwShowWindow(w->glfw);
    glfwPollEvents();
    take_size(w, false); /* only now its monitor and that one's density are known */
    glfwPollEvents();
    w->opens_until = glfwGetTime() + SETTLES;
}

void ec_window_rescale(ec_window *w, double scale)
{
    w->scale = scale;
    w->dirty = true;
    if (glfwGetTime() < w->opens_until) take_size(w, false);
}

void ec_window_fullscreen(ec_window *w, bool on)
{
    double area;
    place now = place_of(w->glfw), to = on ? now : w->before;
    GLFWmonitor *monitor = monitor_of(&to, &area);
    if (on == w->is_full || !monitor) {
        w->input.fullscreen = w->is_full;
        return;
    }
    if (on) {
        w->before = now;
        fill(w->glfw, monitor);
    } else {
        place room = room_of(monitor, w->glfw);
        if (area == 0) to = put_into(&room, &to); /* its monitor is gone */
        glfwSetWindowMonitor(w->glfw, NULL, to.x, to.y, to.width, to.height, 0);
    }
    w->is_full = on;
}
