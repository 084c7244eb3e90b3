/* A window that shows a live session (eclat/eclat.h), as a module of the program, eclat-view.so. Only its single thread uses GLFW and OpenGL, and it
 * never waits for the session. */
#ifndef EC_VIEW_VIEW_H
#define EC_VIEW_VIEW_H

#include <eclat/eclat.h>
#include <stdbool.h>

/* Returns ECLAT_FAILED, with the reason in err, which may be NULL. */
eclat_result ec_view_fail(eclat_error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

typedef struct ec_view_request {
    const eclat_job *job;
    const char *against;             /* path of an .exr to show beside the picture, or NULL */
    const char *script;              /* path, "orbit" or NULL */
    bool stats;                      /* report first light and frame times at the end */
    void *user;
    void (*report)(void *user, const char *text); /* gets results in whole lines, from any thread, one at a time */
    bool (*should_stop)(void *user); /* called when the window wakes, and before it first sleeps; returning true closes it */
} ec_view_request;

/* The module's functions, which the library finds by the name of the variable. */
typedef struct ec_view_module {
    eclat_result (*run)(const ec_view_request *request, eclat_error *err); /* until the window is closed; fails without a window or a picture, or if the last
                                                                            * save failed */
    void (*wake)(void);              /* makes the window call should_stop; from any thread; does nothing if no window is open */
    bool (*key_at)(size_t i, const char **shown, const char **help); /* gets the name of the i-th key and what it does; false beyond the last */
} ec_view_module;
__attribute__((visibility("default"))) extern const ec_view_module ec_module;

#endif
