/* Shows a job that runs: messages and the progress line on standard error, reports on standard output. */
#ifndef EC_CLI_PROGRESS_H
#define EC_CLI_PROGRESS_H

#include "cli/console.h"

typedef struct ec_progress_view {
    ec_console *console;
    bool has_bar;          /* before the progress in words */
    double drawn_at;       /* ec_seconds() of the last line */
    char hint[5000];       /* what ec_stop_hint points at */
    char lost[256];        /* why a report has not arrived */
} ec_progress_view;

eclat_listener ec_progress_listener(ec_progress_view *view); /* valid as long as it */

#endif
