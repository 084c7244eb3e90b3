/* The `eclat render` that makes a picture of the window again, bit for bit. */
#ifndef EC_COMMANDS_VIEW_COMMAND_H
#define EC_COMMANDS_VIEW_COMMAND_H

#include "jobs/render_request.h"
#include "view/view.h"

/* Options of `render` as they were given, but for those that the window sets. */
typedef struct ec_kept_options {
    struct {
        const char *option, *value; /* not owned; value NULL: it has none */
    } row[EC_OPTIONS_MAX];
    int count;
} ec_kept_options;

/* One option counts once: as it was given last. */
void ec_kept_options_add(ec_kept_options *kept, const char *option, const char *value);

/* camera: the one that the options ask for, among the scene's. malloc'ed; NULL: out of memory. */
char *ec_view_command(const ec_render_request *request, const ec_kept_options *kept, uint32_t camera, const ec_view_shot *shot,
                      const ec_outputs *outputs);

#endif
