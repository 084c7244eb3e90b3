/* Handles keys and mouse of the window. */
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <ctype.h>
#include <math.h>
#include <string.h>

#include "view/window.h"

#define TAP 0.3     /* seconds: holding S longer than this flies */
#define WHEEL (log(0.9) / 3) /* drag, in heights of the picture, for a click of the wheel: a tenth nearer */
#define CLICK 4     /* pixels: a shorter drag is a click, which selects */

static ec_window *of(GLFWwindow *glfw) { return glfwGetWindowUserPointer(glfw); }

/* Finds the pixel of the picture under the cursor; UINT32_MAX: none. */
static void find_pixel(const ec_window *w, uint32_t *px, uint32_t *py)
{
    const eclat_view_request *view = &w->input.view;
    int width, height;
    glfwGetFramebufferSize(w->glfw, &width, &height);
    double x = w->cursor_x * view->width / fmax(width, 1), y = w->cursor_y * view->height / fmax(height, 1),
           half = 0.5 * view->width;
    if (w->input.layout == EC_LAYOUT_BESIDE) x = 2 * (x < half ? x : x - half), y = 2 * y - 0.5 * view->height; /* as drawn in window.c */
    bool inside = w->points && x >= 0 && y >= 0 && x < view->width && y < view->height;
    *px = inside ? (uint32_t)x : UINT32_MAX;
    *py = inside ? (uint32_t)y : UINT32_MAX;
}

static void on_enter(GLFWwindow *glfw, int inside)
{
    of(glfw)->points = inside;
}

static void on_cursor(GLFWwindow *glfw, double x, double y)
{
    ec_window *w = of(glfw);
    double scale = ec_window_density(glfw), dx = x * scale - w->cursor_x, dy = y * scale - w->cursor_y;
    double height = fmax(w->input.view.height, 1);
    w->cursor_x = x * scale;
    w->cursor_y = y * scale;
    w->points = w->dirty = true;
    w->drag_path += fabs(dx) + fabs(dy);
    if (w->drag < 0 || w->drag_path <= CLICK || !w->input.facts.serial) return;
    bool shift = glfwGetKey(glfw, GLFW_KEY_LEFT_SHIFT) || glfwGetKey(glfw, GLFW_KEY_RIGHT_SHIFT);
    bool control = glfwGetKey(glfw, GLFW_KEY_LEFT_CONTROL) || glfwGetKey(glfw, GLFW_KEY_RIGHT_CONTROL);
    ec_view_drag drag = w->drag == GLFW_MOUSE_BUTTON_RIGHT ? EC_DRAG_LOOK
                        : w->drag == GLFW_MOUSE_BUTTON_MIDDLE || shift ? EC_DRAG_PAN : control ? EC_DRAG_DOLLY : EC_DRAG_ORBIT;
    ec_view_input_drag(&w->input, drag, dx / height, dy / height);
}

void ec_window_point(ec_window *w)
{
    double at_x, at_y;
    glfwGetCursorPos(w->glfw, &at_x, &at_y);
    bool at_corner = at_x == 0 && at_y == 0 && glfwGetWindowAttrib(w->glfw, GLFW_HOVERED); /* which GLFW does not report under X11 */
    if (at_corner && (w->cursor_x != 0 || w->cursor_y != 0 || !w->points)) on_cursor(w->glfw, 0, 0);
    find_pixel(w, &w->input.view.x, &w->input.view.y);
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
        if (button == GLFW_MOUSE_BUTTON_LEFT && w->drag_path <= CLICK) {
            uint32_t x, y;
            find_pixel(w, &x, &y);
            eclat_live_pick(w->live, x, y);
        }
        w->drag = -1;
    }
}

static void on_scroll(GLFWwindow *glfw, double x, double y)
{
    ec_window *w = of(glfw);
    (void)x;
    if (w->input.facts.serial && y != 0) ec_view_input_drag(&w->input, EC_DRAG_DOLLY, 0, y * WHEEL); /* horizontal scrolling does nothing */
    w->dirty = true;
}

/* Takes characters, so that keys are found where each keyboard layout prints them. */
static void on_char(GLFWwindow *glfw, unsigned code)
{
    ec_window *w = of(glfw);
    if (code > 126 || glfwGetKey(glfw, GLFW_KEY_LEFT_SUPER) || glfwGetKey(glfw, GLFW_KEY_RIGHT_SUPER)) return;
    const char name[2] = {(char)code, 0};
    w->told_at = 0;
    w->dirty = true;
    ec_view_input_key(&w->input, name);
}

/* Returns the small Latin letter of a key; 0: none. On keyboards with other letters, *is_other is set, and the letter is the one at that place on a
 * US keyboard. */
static char letter_of(int key, int scancode, bool *is_other)
{
    const char *label = glfwGetKeyName(key, scancode);
    *is_other = label && (label[0] & 0x80) && key >= GLFW_KEY_A && key <= GLFW_KEY_Z;
    if (*is_other) return (char)('a' + key - GLFW_KEY_A);
    return label && isalpha((unsigned char)label[0]) && !label[1] ? (char)tolower((unsigned char)label[0]) : 0;
}

static void hold(ec_window *w, char letter, int action)
{
    static const char fly[] = "wad";
    const char *at = letter ? strchr(fly, letter) : NULL;
    if (at && action == GLFW_PRESS) w->flies |= 1u << (at - fly);
    if (at && action == GLFW_RELEASE) w->flies &= ~(1u << (at - fly));
}

static void on_key(GLFWwindow *glfw, int key, int scancode, int action, int mods)
{
    ec_window *w = of(glfw);
    static const struct {
        int key;
        const char *name;
    } named[] = {{GLFW_KEY_ESCAPE, "Escape"}, {GLFW_KEY_TAB, "Tab"}, {GLFW_KEY_F5, "F5"}, {GLFW_KEY_F11, "F11"}};
    bool is_other;
    if (action == GLFW_PRESS && (mods & GLFW_MOD_SUPER)) return; /* belongs to the desktop */
    char letter = letter_of(key, scancode, &is_other);
    bool is_s = letter == 's';
    hold(w, letter, action);
    if (is_other && action == GLFW_PRESS) on_char(glfw, (unsigned)(mods & GLFW_MOD_SHIFT ? toupper(letter) : letter));
    w->dirty = true;
    if (is_s && action == GLFW_PRESS) w->s_down = glfwGetTime(), w->s_flew = false;
    if (is_s && action == GLFW_RELEASE) {
        bool tapped = w->s_down > 0 && !w->s_flew && w->drag < 0;
        w->s_down = 0;
        if (tapped) ec_view_input_do(&w->input, ec_view_action_of("Save"));
    }
    if (action != GLFW_PRESS) return;
    for (size_t i = 0; i < sizeof named / sizeof named[0]; i++)
        if (named[i].key == key) ec_view_input_do(&w->input, ec_view_action_of(named[i].name));
}

static int held(const ec_window *w, unsigned letter, int arrow)
{
    return (w->flies & letter) || glfwGetKey(w->glfw, arrow) == GLFW_PRESS;
}

void ec_window_fly(ec_window *w)
{
    GLFWwindow *g = w->glfw;
    double now = glfwGetTime(), seconds = fmin(now - w->flown, 0.1);
    bool control = glfwGetKey(g, GLFW_KEY_LEFT_CONTROL) || glfwGetKey(g, GLFW_KEY_RIGHT_CONTROL);
    bool s = w->s_down > 0 && !control && (now - w->s_down >= TAP || w->drag == GLFW_MOUSE_BUTTON_RIGHT);
    int forward = held(w, 1, GLFW_KEY_UP) - (s || glfwGetKey(g, GLFW_KEY_DOWN));
    int right = held(w, 4, GLFW_KEY_RIGHT) - held(w, 2, GLFW_KEY_LEFT);
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
    if (width <= 0 || height <= 0) return; /* some systems report this when minimised */
    ec_window_fit(w, width, height);
}

static void on_iconify(GLFWwindow *glfw, int iconified)
{
    of(glfw)->iconified = iconified;
    of(glfw)->dirty = true;
}

static void on_refresh(GLFWwindow *glfw) { of(glfw)->dirty = true; }

static void on_scale(GLFWwindow *glfw, float x, float y)
{
    ec_window_rescale(of(glfw), (double)fmaxf(x, y));
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
