/* A window that shows a live session (eclat/eclat.h). A module of the program, eclat-view.so, whose one thread alone knows GLFW and OpenGL, and never
 * waits for the session. */
#ifndef EC_VIEW_VIEW_H
#define EC_VIEW_VIEW_H

#include <eclat/eclat.h>
#include <stdbool.h>

/* Returns ECLAT_FAILED, and tells why in err, which may be NULL. */
eclat_result ec_view_fail(eclat_error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

typedef struct ec_view_request {
    const eclat_job *job;
    const char *against;             /* .exr beside the picture, or NULL */
    const char *script;              /* file, "orbit" or NULL */
    bool stats;                      /* reports first light and frame times at the end */
    void *user;
    void (*report)(void *user, const char *text); /* results, whole lines; from any thread, one at a time */
    bool (*should_stop)(void *user); /* asked when the window wakes, and before it sleeps for the first time: true closes it */
} ec_view_request;

/* The module's functions; the library looks them up by the name of the variable. */
typedef struct ec_view_module {
    eclat_result (*run)(const ec_view_request *request, eclat_error *err); /* until the window is closed. Fails where there can be no window, no
                                                                            * picture, or where the last save failed */
    void (*wake)(void);              /* lets it ask whether it should stop, from any thread; nothing where no window is open yet */
    bool (*key_at)(size_t i, const char **shown, const char **help); /* what the i-th key is called and does; false behind the last */
} ec_view_module;
__attribute__((visibility("default"))) extern const ec_view_module ec_module;

#endif
