/* The window: GLFW and OpenGL. */
#ifndef EC_VIEW_WINDOW_H
#define EC_VIEW_WINDOW_H

#include "view/frames.h"
#include "view/input.h"
#include "view/script.h"
#include "view/glyphs.h"
#include "view/texture_upload.h"
#include "view/view.h"

struct GLFWwindow;

/* In screen coordinates, without the frame. */
typedef struct ec_window_place {
    int x, y, width, height;
} ec_window_place;

typedef struct ec_window {
    const ec_view_request *request;
    eclat_live *live;
    struct GLFWwindow *glfw;
    ec_view_textures textures;
    ec_view_text text, small;   /* small: limited so that the help fits */
    ec_view_input input;
    eclat_status status;        /* as last read */
    ec_script script;
    ec_frames frames;
    double scale;               /* of text: that of the monitor */
    double cursor_x, cursor_y;  /* pixels of the framebuffer, from the top left */
    bool points;                /* the cursor is in the window */
    int drag;                   /* mouse button that is down, or -1 */
    uint32_t picks;             /* number of answered clicks that were handled */
    double drag_path;           /* pixels that the drag has covered: a click does not move the camera */
    double moved_at;            /* time of the last move of the camera; times are glfwGetTime's */
    double s_down;              /* time when S was pressed; 0: it is up */
    bool s_flew;                /* S was held to fly, and is no tap */
    unsigned flies;             /* bits for W, A, D being down, wherever the keyboard has them */
    double flown;               /* time of the last step of flight */
    double told_at;             /* time when a save was reported */
    bool telling;               /* the report is still shown */
    bool iconified, dirty, is_full;
    bool has_second;            /* the requested second picture is there, and up to date */
    int drawn_width, drawn_height; /* size of the last frame */
    ec_window_place before;     /* before full screen */
    bool restores;              /* it was full screen when its monitor disappeared */
    unsigned monitor_changes;   /* number of changes handled */
    double monitors_settle;     /* time when window managers are done with the last change */
    uint32_t asked_width, asked_height; /* pixels, when it opened */
    double opens_until;         /* until then the window is kept at the size asked for */
} ec_window;

eclat_result ec_window_open(ec_window *window, eclat_error *err); /* opens it hidden; *window: zero except for request and live */
void ec_window_size(ec_window *window, uint32_t width, uint32_t height); /* sets the size in pixels, as far as the monitor has room, and shows it */
void ec_window_fly(ec_window *window);    /* flies by the keys that are held */
void ec_window_draw(ec_window *window);
void ec_window_close(ec_window *window);  /* may be half-open */

/* place.c: where the window is */
double ec_window_density(struct GLFWwindow *glfw); /* pixels per screen coordinate: more than one on dense screens */
void ec_window_fit(ec_window *window, int width, int height);                 /* fits the picture to the framebuffer */
void ec_window_stand(ec_window *window, uint32_t width, uint32_t height); /* shows it for the first time with this size, as far as the monitor has room */
void ec_window_rescale(ec_window *window, double scale);                  /* adapts to the monitor's scale, or to another monitor's */
void ec_window_fullscreen(ec_window *window, bool on);                    /* input.fullscreen tells the result */
void ec_window_follow_monitors(ec_window *window);                        /* reacts to monitors that have come or gone */

void ec_view_overlay_draw(const ec_window *window, double width, double height); /* draws the lines over the picture */

/* controls.c: GLFW's callbacks */
void ec_window_listen(ec_window *window);
void ec_window_point(ec_window *window); /* updates what is under the cursor, wherever a picture is shown now */

#endif
