#include "view/window.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>
#include <stdlib.h>

#include "view/view.h"
#include "view/lists.h"

#define TEXT_SIZE 15     /* pixels, for a monitor scale of 1 */
#define TEXT_LEAST 11
#define COLUMNS 64       /* text shrinks until this many fit */

static eclat_result glfw_failed(const char *what, eclat_error *err)
{
    const char *why = NULL;
    glfwGetError(&why);
    return ec_view_fail(err, "no preview window: %s: %s; 'eclat render' needs no display", what, why ? why : "GLFW does not say why");
}

eclat_result ec_window_open(ec_window *w, eclat_error *err)
{
    w->drag = -1;
    if (!glfwInit()) return glfw_failed("cannot reach a display", err);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 2);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 1);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE); /* stays full screen while another monitor is used */
    w->glfw = glfwCreateWindow(640, 480, "eclat", NULL, NULL);
    if (!w->glfw) return glfw_failed("cannot open one with OpenGL 2.1", err);
    glfwMakeContextCurrent(w->glfw);
    glfwSwapInterval(getenv("WAYLAND_DISPLAY") ? 0 : 1); /* Wayland does not tear, and would block while the window is out of sight */
    float x, y;
    glfwGetWindowContentScale(w->glfw, &x, &y);
    w->scale = (double)fmaxf(x, y);
    ec_window_listen(w);
    return ec_view_textures_make(&w->textures, err);
}

void ec_window_size(ec_window *w, uint32_t width, uint32_t height)
{
    char title[300];
    int across, down;
    snprintf(title, sizeof title, "%s - eclat", w->input.facts.scene);
    glfwSetWindowTitle(w->glfw, title);
    ec_window_stand(w, width, height);
    glfwGetFramebufferSize(w->glfw, &across, &down);
    ec_window_fit(w, across, down);
    w->dirty = true;
}

static bool has_second(const ec_window *w)
{
    const eclat_view_request *view = &w->input.view;
    const eclat_status *s = &w->status;
    return view->second && w->textures.width[ECLAT_SECOND_PICTURE] && s->second == view->second &&
           (view->second != ECLAT_SECOND_INTEGRATOR || s->second_integrator == view->second_integrator);
}

static void draw_pictures(const ec_window *w, double width, double height)
{
    const ec_view_textures *t = &w->textures;
    double wipe = fmin(fmax(w->cursor_x, 0), width);
    if (w->input.layout == EC_LAYOUT_BESIDE) {
        double shown = 0.5 * height, foot = 0.25 * height; /* half as wide as the window, in proportion */
        glPushMatrix();
        glTranslated(0, foot, 0);
        ec_view_textures_draw(t, ECLAT_PICTURE, 0, 0.5 * width, shown, 0, 1);
        if (w->has_second) ec_view_textures_draw(t, ECLAT_SECOND_PICTURE, 0.5 * width, width, shown, 0, 1);
        glPopMatrix();
        return;
    }
    ec_view_textures_draw(t, ECLAT_PICTURE, 0, width, height, 0, 1);
    if (!w->has_second) return;
    ec_view_textures_draw(t, ECLAT_SECOND_PICTURE, wipe, width, height, wipe / width, 1);
    ec_view_veil(wipe - 1, 0, wipe + 1, height);
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
    w->has_second = has_second(w);
    draw_pictures(w, width, height);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    if (w->text.glyphs && (w->small.glyphs || !w->input.help)) ec_view_overlay_draw(w, width, height);
    glfwSwapBuffers(w->glfw);
    w->dirty = width != w->drawn_width || height != w->drawn_height; /* some drivers learn of a new size only from the first, wrong frame */
    w->drawn_width = width;
    w->drawn_height = height;
}

void ec_window_close(ec_window *w)
{
    if (w->glfw) {
        ec_view_text_free(&w->text);
        ec_view_text_free(&w->small);
        ec_view_textures_free(&w->textures);
        glfwDestroyWindow(w->glfw);
    }
    glfwTerminate();
    ec_frames_free(&w->frames);
}
