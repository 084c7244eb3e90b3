#include "view/window.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "view/lists.h"
#include "view/overlay.h"

#define TEXT_SIZE 15     /* pixels, where the monitor's scale is 1 */
#define TEXT_LEAST 11
#define COLUMNS 64       /* that text grows smaller for */

static ec_result glfw_failed(const char *what, ec_error *err)
{
    const char *why = NULL;
    glfwGetError(&why);
    return ec_fail(err, "no preview window: %s: %s; 'eclat render' needs no display", what, why ? why : "GLFW does not say why");
}

ec_result ec_window_open(ec_window *w, ec_view *view, ec_error *err)
{
    w->view = view;
    w->drag = -1;
    if (!glfwInit()) return glfw_failed("cannot reach a display", err);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 2);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 1);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    w->glfw = glfwCreateWindow(640, 480, "eclat", NULL, NULL);
    if (!w->glfw) return glfw_failed("cannot open one with OpenGL 2.1", err);
    glfwMakeContextCurrent(w->glfw);
    glfwSwapInterval(1);
    float x, y;
    glfwGetWindowContentScale(w->glfw, &x, &y);
    w->scale = (double)fmaxf(x, y);
    EC_TRY(ec_view_textures_make(&w->textures, err));
    ec_window_listen(w);
    return EC_OK;
}

void ec_window_fit(ec_window *w, int width, int height)
{
    ec_view_wish *wish = &w->input.wish;
    wish->width = (uint32_t)fmin(fmax(width, 1), w->textures.largest); /* beyond that it is stretched */
    wish->height = (uint32_t)fmin(fmax(height, 1), w->textures.largest);
    ec_view_textures_fit(&w->textures, w->view, (size_t)wish->width * wish->height * 3);
}

void ec_window_size(ec_window *w, uint32_t width, uint32_t height)
{
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    char title[300];
    int x = 0, y = 0, most_width = 0, most_height = 0, across, down;
    snprintf(title, sizeof title, "%s - eclat", w->view->request->scene);
    glfwSetWindowTitle(w->glfw, title);
    glfwShowWindow(w->glfw);
    if (monitor) glfwGetMonitorWorkarea(monitor, &x, &y, &most_width, &most_height);
    glfwGetWindowSize(w->glfw, &across, &down);
    int framebuffer_width, framebuffer_height;
    glfwGetFramebufferSize(w->glfw, &framebuffer_width, &framebuffer_height);
    double density = across > 0 && framebuffer_width > 0 ? (double)framebuffer_width / across : 1, shrink = 1;
    if (most_width > 0) shrink = fmin(1, fmin(most_width * density / width, most_height * density / height));
    across = (int)fmax(round(width * shrink / density), 1);
    down = (int)fmax(round(height * shrink / density), 1);
    glfwSetWindowSize(w->glfw, across, down);
    glfwPollEvents();
    glfwGetFramebufferSize(w->glfw, &framebuffer_width, &framebuffer_height);
    ec_window_fit(w, framebuffer_width, framebuffer_height);
    w->shown = w->dirty = true;
}

/* The monitor that has most of the window. */
static GLFWmonitor *monitor_of(GLFWwindow *glfw)
{
    int count, x, y, width, height, most = -1;
    GLFWmonitor **monitors = glfwGetMonitors(&count), *best = NULL;
    glfwGetWindowPos(glfw, &x, &y);
    glfwGetWindowSize(glfw, &width, &height);
    for (int i = 0; i < count; i++) {
        int mx, my;
        const GLFWvidmode *mode = glfwGetVideoMode(monitors[i]);
        glfwGetMonitorPos(monitors[i], &mx, &my);
        int wide = (int)(fmin(x + width, mx + mode->width) - fmax(x, mx)), high = (int)(fmin(y + height, my + mode->height) - fmax(y, my));
        int area = wide > 0 && high > 0 ? wide * high : 0;
        if (area > most) best = monitors[i], most = area;
    }
    return best;
}

void ec_window_fullscreen(ec_window *w, bool on)
{
    GLFWmonitor *monitor = monitor_of(w->glfw);
    if (on == w->is_full || !monitor) return;
    const GLFWvidmode *mode = glfwGetVideoMode(monitor);
    if (on) {
        glfwGetWindowPos(w->glfw, &w->old_x, &w->old_y);
        glfwGetWindowSize(w->glfw, &w->old_width, &w->old_height);
        glfwSetWindowMonitor(w->glfw, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    } else {
        glfwSetWindowMonitor(w->glfw, NULL, w->old_x, w->old_y, w->old_width, w->old_height, 0);
    }
    w->is_full = on;
}

static void draw_pictures(const ec_window *w, double width, double height)
{
    const ec_view_textures *t = &w->textures;
    bool second = w->input.layout != EC_LAYOUT_ONE && t->width[EC_ROLE_SECOND];
    double wipe = fmin(fmax(w->cursor_x, 0), width);
    if (second && w->input.layout == EC_LAYOUT_BESIDE) {
        double shown = 0.5 * height, foot = 0.25 * height; /* as wide as half the window, in proportion */
        glPushMatrix();
        glTranslated(0, foot, 0);
        ec_view_textures_draw(t, EC_ROLE_PICTURE, 0, 0.5 * width, shown, 0, 1);
        ec_view_textures_draw(t, EC_ROLE_SECOND, 0.5 * width, width, shown, 0, 1);
        glPopMatrix();
        return;
    }
    ec_view_textures_draw(t, EC_ROLE_PICTURE, 0, width, height, 0, 1);
    if (!second) return;
    ec_view_textures_draw(t, EC_ROLE_SECOND, wipe, width, height, wipe / width, 1);
    ec_view_veil(wipe - 1, 0, wipe + 1, height);
}

static void draw_overlay(const ec_window *w, double width, double height)
{
    const ec_view_overlay overlay = {.wish = &w->input.wish, .status = &w->status, .facts = &w->input.facts, .request = w->view->request,
                                     .layout = w->input.layout, .lines = w->input.lines, .help = w->input.help, .effects = w->input.effects,
                                     .message = w->telling,
                                     .selected = &w->input.selected, .small = &w->small};
    ec_view_overlay_draw(&overlay, &w->text, width, height);
}

static void fit_text(ec_view_text *text, double size)
{
    if (text->size == size) return;
    ec_view_text_free(text);
    ec_view_text_make(text, size, NULL);
}

void ec_window_draw(ec_window *w)
{
    int width, height;
    glfwGetFramebufferSize(w->glfw, &width, &height);
    if (width <= 0 || height <= 0) return;
    double scale = fmax(w->scale, 0.5), fits = fmax(round(width / (COLUMNS * EC_TEXT_NARROW)), round(TEXT_LEAST * scale));
    fit_text(&w->text, fmin(round(TEXT_SIZE * scale), fits));
    if (w->input.help) fit_text(&w->small, ec_view_help_size(round(TEXT_SIZE * scale), width, height));
    glViewport(0, 0, width, height);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glOrtho(0, width, 0, height, -1, 1);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glDisable(GL_BLEND);
    draw_pictures(w, width, height);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    if (w->text.glyphs && (w->small.glyphs || !w->input.help)) draw_overlay(w, width, height);
    glfwSwapBuffers(w->glfw);
    w->dirty = width != w->drawn_width || height != w->drawn_height; /* some drivers learn of a new size from the frame that is wrong */
    w->drawn_width = width;
    w->drawn_height = height;
}

void ec_window_close(ec_window *w)
{
    if (w->glfw) {
        ec_view_text_free(&w->text);
        ec_view_text_free(&w->small);
        ec_view_textures_free(&w->textures, w->view);
        glfwDestroyWindow(w->glfw);
    }
    glfwTerminate();
    ec_frames_free(&w->frames);
}
