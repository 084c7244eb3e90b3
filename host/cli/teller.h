/* The listener of the command line: messages and progress to standard error, results to standard output, Ctrl-C. */
#ifndef EC_CLI_TELLER_H
#define EC_CLI_TELLER_H

#include "cli/progress.h"
#include "jobs/listener.h"

typedef struct ec_teller {
    ec_console *console;
    bool quiet, json;           /* results: none; as JSON */
    ec_progress_view progress;
    char hint[5000];            /* what ec_stop_hint points at */
} ec_teller;

ec_listener ec_teller_listener(ec_teller *teller); /* valid as long as it */

#endif
