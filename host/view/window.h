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
    ec_view_text text, small;   /* small: no larger than the help can be */
    ec_view_input input;
    eclat_status status;        /* the last that was looked at */
    ec_script script;
    ec_frames frames;
    double scale;               /* of text: the monitor's */
    double cursor_x, cursor_y;  /* pixels of the framebuffer, from the top left */
    bool points;                /* the cursor is in the window */
    int drag;                   /* mouse button that is down, or -1 */
    uint32_t picks;             /* answered clicks that have been seen */
    double drag_path;           /* how far it went: a click does not move */
    double moved_at;            /* when the camera was moved last; times are glfwGetTime's */
    double s_down;              /* when S went down; 0: it is up */
    bool s_flew;                /* and is no tap */
    unsigned flies;             /* bits: W, A, D are down, wherever the keyboard has them */
    double flown;               /* when the last step of flight was */
    double told_at;             /* when a save was told */
    bool telling;               /* it still is */
    bool iconified, dirty, is_full;
    bool has_second;            /* that which is wished is there, and no other or older one */
    int drawn_width, drawn_height; /* of the last frame */
    ec_window_place before;     /* full screen */
    bool restores;              /* it was full screen when its monitor went */
    unsigned monitor_changes;   /* that have been seen */
    double monitors_settle;     /* when window managers are done with the last */
    uint32_t asked_width, asked_height; /* pixels at first */
    double opens_until;         /* until then it has them, or the user what he made of it */
} ec_window;

eclat_result ec_window_open(ec_window *window, eclat_error *err); /* hidden; of a zeroed one with request and live */
void ec_window_size(ec_window *window, uint32_t width, uint32_t height); /* in pixels, as far as the monitor has room; and shows it */
void ec_window_fly(ec_window *window);    /* by the keys that are held */
void ec_window_draw(ec_window *window);
void ec_window_close(ec_window *window);  /* half-open ones are fine */

/* place.c: where it stands */
double ec_window_density(struct GLFWwindow *glfw); /* pixels a screen coordinate: more than one where the screen is dense */
void ec_window_fit(ec_window *window, int width, int height);                 /* the picture to the framebuffer */
void ec_window_stand(ec_window *window, uint32_t width, uint32_t height); /* shows it for the first time: so large, as far as its monitor has room */
void ec_window_rescale(ec_window *window, double scale);                  /* the monitor's, or another monitor's */
void ec_window_fullscreen(ec_window *window, bool on);                    /* input.fullscreen says what came of it */
void ec_window_follow_monitors(ec_window *window);                        /* where one has come or gone since the last time */

void ec_view_overlay_draw(const ec_window *window, double width, double height); /* the lines over the picture */

/* controls.c: GLFW's callbacks */
void ec_window_listen(ec_window *window);
void ec_window_point(ec_window *window); /* what is under the cursor, wherever a picture is shown now */

#endif
