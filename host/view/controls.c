/* Keys and mouse of the window. */
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "view/window.h"

#define TAP 0.3     /* seconds: S that is down longer than this flies */
#define CLICK 4     /* pixels: a drag that goes no further selects */

static ec_window *of(GLFWwindow *glfw) { return glfwGetWindowUserPointer(glfw); }

/* Screen coordinates are not pixels where the screen is dense. */
static double pixels_a_unit(GLFWwindow *glfw)
{
    int width, height, across, down;
    glfwGetWindowSize(glfw, &width, &height);
    glfwGetFramebufferSize(glfw, &across, &down);
    return width > 0 ? (double)across / width : 1;
}

static void probe(ec_window *w)
{
    ec_view_wish *wish = &w->input.wish;
    double x = w->cursor_x, half = 0.5 * wish->width;
    if (w->input.layout == EC_LAYOUT_BESIDE) x = 2 * (x < half ? x : x - half);
    if (x < 0 || w->cursor_y < 0 || x >= wish->width || w->cursor_y >= wish->height) return;
    wish->probe_x = (uint32_t)x;
    wish->probe_y = (uint32_t)w->cursor_y;
    wish->probes++;
}

static void on_enter(GLFWwindow *glfw, int inside)
{
    ec_window *w = of(glfw);
    if (inside) return;
    w->input.wish.probe_x = w->input.wish.probe_y = UINT32_MAX;
    w->input.wish.probes++;
}

static void on_cursor(GLFWwindow *glfw, double x, double y)
{
    ec_window *w = of(glfw);
    double scale = pixels_a_unit(glfw), dx = x * scale - w->cursor_x, dy = y * scale - w->cursor_y;
    double height = fmax(w->input.wish.height, 1);
    w->cursor_x = x * scale;
    w->cursor_y = y * scale;
    w->dirty = true;
    probe(w);
    w->drag_path += fabs(dx) + fabs(dy);
    if (w->drag < 0 || w->drag_path <= CLICK || !w->input.facts.serial) return;
    bool shift = glfwGetKey(glfw, GLFW_KEY_LEFT_SHIFT) || glfwGetKey(glfw, GLFW_KEY_RIGHT_SHIFT);
    bool control = glfwGetKey(glfw, GLFW_KEY_LEFT_CONTROL) || glfwGetKey(glfw, GLFW_KEY_RIGHT_CONTROL);
    ec_view_drag drag = w->drag == GLFW_MOUSE_BUTTON_RIGHT ? EC_DRAG_LOOK
                        : w->drag == GLFW_MOUSE_BUTTON_MIDDLE || shift ? EC_DRAG_PAN : control ? EC_DRAG_DOLLY : EC_DRAG_ORBIT;
    ec_view_input_drag(&w->input, drag, dx / height, dy / height);
}

static void on_button(GLFWwindow *glfw, int button, int action, int mods)
{
    ec_window *w = of(glfw);
    (void)mods;
    w->dirty = true;
    if (action == GLFW_PRESS && w->drag < 0) {
        w->drag = button;
        w->drag_path = 0;
    } else if (action == GLFW_RELEASE && button == w->drag) {
        if (button == GLFW_MOUSE_BUTTON_LEFT && w->drag_path <= CLICK) w->selecting = w->input.wish.probes;
        w->drag = -1;
    }
}

static void on_scroll(GLFWwindow *glfw, double x, double y)
{
    ec_window *w = of(glfw);
    (void)x;
    if (w->input.facts.serial) ec_view_input_wheel(&w->input, y);
    w->dirty = true;
}

/* Characters, so that every keyboard layout has them where they are printed. */
static void on_char(GLFWwindow *glfw, unsigned code)
{
    ec_window *w = of(glfw);
    if (code > 126 || !w->input.facts.serial) return;
    const char name[2] = {(char)code, 0};
    w->told_at = 0;
    w->dirty = true;
    if (w->input.effects && code >= '1' && code <= '9') ec_view_input_digit(&w->input, (int)code - '0');
    else ec_view_input_do(&w->input, ec_view_action_of(name));
}

static void on_key(GLFWwindow *glfw, int key, int scancode, int action, int mods)
{
    (void)mods;
    ec_window *w = of(glfw);
    static const struct {
        int key;
        const char *name;
    } named[] = {{GLFW_KEY_ESCAPE, "Escape"}, {GLFW_KEY_TAB, "Tab"}, {GLFW_KEY_F5, "F5"}, {GLFW_KEY_F11, "F11"}};
    const char *label = glfwGetKeyName(key, scancode);
    bool is_s = label && (!strcmp(label, "s") || !strcmp(label, "S"));
    w->dirty = true;
    if (is_s && action == GLFW_PRESS) w->s_down = ec_now(), w->s_flew = false;
    if (is_s && action == GLFW_RELEASE) {
        bool tapped = w->s_down > 0 && !w->s_flew && w->drag < 0;
        w->s_down = 0;
        if (tapped) ec_view_input_do(&w->input, ec_view_action_of("Save"));
    }
    if (action != GLFW_PRESS || (!w->input.facts.serial && key != GLFW_KEY_ESCAPE)) return;
    for (size_t i = 0; i < sizeof named / sizeof named[0]; i++)
        if (named[i].key == key) ec_view_input_do(&w->input, ec_view_action_of(named[i].name));
}

static int held(GLFWwindow *glfw, int key, int arrow)
{
    return glfwGetKey(glfw, key) == GLFW_PRESS || glfwGetKey(glfw, arrow) == GLFW_PRESS;
}

void ec_window_fly(ec_window *w)
{
    GLFWwindow *g = w->glfw;
    double now = ec_now(), seconds = fmin(now - w->flown, 0.1);
    bool control = glfwGetKey(g, GLFW_KEY_LEFT_CONTROL) || glfwGetKey(g, GLFW_KEY_RIGHT_CONTROL);
    bool s = w->s_down > 0 && !control && (now - w->s_down >= TAP || w->drag == GLFW_MOUSE_BUTTON_RIGHT);
    int forward = held(g, GLFW_KEY_W, GLFW_KEY_UP) - (s || glfwGetKey(g, GLFW_KEY_DOWN));
    int right = held(g, GLFW_KEY_D, GLFW_KEY_RIGHT) - held(g, GLFW_KEY_A, GLFW_KEY_LEFT);
    int up = glfwGetKey(g, GLFW_KEY_PAGE_UP) - glfwGetKey(g, GLFW_KEY_PAGE_DOWN);
    w->flown = now;
    w->s_flew |= s;
    if ((!forward && !right && !up) || control || !w->input.facts.serial) return;
    double pace = glfwGetKey(g, GLFW_KEY_LEFT_SHIFT) || glfwGetKey(g, GLFW_KEY_RIGHT_SHIFT) ? 4 : 1;
    ec_view_input_fly(&w->input, forward * pace, right * pace, up * pace, seconds);
    w->dirty = true;
}

static void on_framebuffer(GLFWwindow *glfw, int width, int height)
{
    ec_window *w = of(glfw);
    w->dirty = true;
    if (width <= 0 || height <= 0) return; /* minimised, on some systems */
    w->input.wish.width = (uint32_t)width;
    w->input.wish.height = (uint32_t)height;
    ec_view_textures_fit(&w->textures, w->view, (size_t)width * (size_t)height * 3);
}

static void on_iconify(GLFWwindow *glfw, int iconified)
{
    of(glfw)->iconified = iconified;
    of(glfw)->dirty = true;
}

static void on_refresh(GLFWwindow *glfw) { of(glfw)->dirty = true; }

static void on_scale(GLFWwindow *glfw, float x, float y)
{
    of(glfw)->scale = (double)fmaxf(x, y);
    of(glfw)->dirty = true;
}

void ec_window_listen(ec_window *w)
{
    glfwSetWindowUserPointer(w->glfw, w);
    glfwSetCursorEnterCallback(w->glfw, on_enter);
    glfwSetCursorPosCallback(w->glfw, on_cursor);
    glfwSetMouseButtonCallback(w->glfw, on_button);
    glfwSetScrollCallback(w->glfw, on_scroll);
    glfwSetCharCallback(w->glfw, on_char);
    glfwSetKeyCallback(w->glfw, on_key);
    glfwSetFramebufferSizeCallback(w->glfw, on_framebuffer);
    glfwSetWindowIconifyCallback(w->glfw, on_iconify);
    glfwSetWindowRefreshCallback(w->glfw, on_refresh);
    glfwSetWindowContentScaleCallback(w->glfw, on_scale);
}
