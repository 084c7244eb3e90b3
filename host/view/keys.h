/* One table of keys, used by the window, the help overlay and `eclat view --help`. */
#ifndef EC_VIEW_KEYS_H
#define EC_VIEW_KEYS_H

#include <stddef.h>

typedef enum ec_view_action {
    EC_DO_NOTHING, /* only a line of help: what the mouse or held keys do */
    EC_DO_HELP,
    EC_DO_INTEGRATOR_PATH, /* in the order of eclat_integrator */
    EC_DO_INTEGRATOR_WHITTED,
    EC_DO_INTEGRATOR_RASTER,
    EC_DO_INTEGRATOR_LIGHT,
    EC_DO_BRIGHTER,
    EC_DO_DARKER,
    EC_DO_TONEMAP,
    EC_DO_ENV_LEFT,
    EC_DO_ENV_RIGHT,
    EC_DO_CAMERA,
    EC_DO_FRAME,
    EC_DO_RESET,
    EC_DO_SECOND,
    EC_DO_LAYOUT,
    EC_DO_RUNG,
    EC_DO_LINES,
    EC_DO_EFFECTS,
    EC_DO_MORE,
    EC_DO_DENOISE,
    EC_DO_SAVE,
    EC_DO_RELOAD,
    EC_DO_FULLSCREEN,
    EC_DO_QUIT
} ec_view_action;

typedef struct ec_view_key {
    const char *names[2]; /* the characters it types with the current layout and shift; or the name of a key without a character */
    ec_view_action action;
    const char *shown;    /* its name in the help */
    const char *help;
} ec_view_key;

extern const ec_view_key ec_view_keys[];
extern const size_t ec_view_key_count;

/* Finds an action by a typed character ("e", "E", "?") or a name ("Escape", "F11", "Tab"). */
ec_view_action ec_view_action_of(const char *name);

#endif
