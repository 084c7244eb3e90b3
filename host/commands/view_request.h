/* What `eclat view` is asked for. */
#ifndef EC_COMMANDS_VIEW_REQUEST_H
#define EC_COMMANDS_VIEW_REQUEST_H

#include "jobs/render_request.h"

typedef struct ec_view_options {
    ec_render_request render; /* first: the setters of its options are used, to refuse values at once */
    const char *against, *script;
    bool stats;
} ec_view_options;

#endif
