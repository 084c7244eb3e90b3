/* Shows a running job: messages and progress on standard error, reports on standard output. */
#ifndef EC_CLI_PROGRESS_H
#define EC_CLI_PROGRESS_H

#include "cli/console.h"

typedef struct ec_progress_view {
    ec_console *console;
    bool has_bar;          /* draws a bar in front of the progress text */
    double drawn_at;       /* ec_seconds() when the line was last drawn */
    char hint[5000];       /* the text that ec_stop_hint points to */
    char lost[256];        /* why a report could not be written */
} ec_progress_view;

eclat_listener ec_progress_listener(ec_progress_view *view); /* valid as long as *view */

#endif
