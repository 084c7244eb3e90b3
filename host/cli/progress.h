/* The progress line of a render: samples done, samples/s, error, time left. */
#ifndef EC_CLI_PROGRESS_H
#define EC_CLI_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cli/console.h"
#include "render/render.h"

typedef struct ec_progress_view {
    ec_console *console;
    const ec_render_options *options;
    bool foretold;         /* the forecast has been told */
    double drawn_at;       /* ec_now() of the last line */
} ec_progress_view;

/* An ec_progress_fn; user is an ec_progress_view. False on Ctrl-C. */
bool ec_progress_show(void *user, const ec_progress *progress);

/* "[====   ] 37 %  0:12 left  96 spp  5.42 M samples/s  error 2.31 % (bound 2.40 %)"; the bar takes what the columns
 * leave. */
void ec_progress_format(const ec_progress *progress, int columns, char *line, size_t size);

#endif
