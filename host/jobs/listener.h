/* Receives what a job says while it runs, and may stop it. */
#ifndef EC_JOBS_LISTENER_H
#define EC_JOBS_LISTENER_H

#include <stdio.h>

#include "render/render.h"

/* Progress of a job that is not a single render. */
typedef struct ec_step {
    const char *doing;
    uint32_t done, count;
    double seconds, seconds_left, fraction; /* seconds_left < 0: unknown */
} ec_step;

/* No function is NULL; all are called from the thread that runs the job. */
typedef struct ec_listener {
    void *user;
    ec_log log;
    /* From here on a kill would lose something. has_progress: progress is reported until `end`; options: those of the render, or NULL. */
    void (*begin)(void *user, const ec_render_options *options, bool has_progress);
    bool (*progress)(void *user, const ec_progress *progress);     /* returning false stops the job, which keeps what there is */
    bool (*step)(void *user, const ec_step *step);                 /* likewise */
    void (*end)(void *user);                                       /* after the last progress */
    bool (*should_stop)(void *user);
    void (*hint)(void *user, const char *line);                    /* gives the text to show if the job is stopped from outside */
    FILE *to;                                                      /* the result of the job, or of a part, is written here, */
    ec_result (*report)(void *user, ec_error *err);                /* and delivered by this, or when the job ends. Anything but EC_OK ends the job */
    bool bold;                                                     /* what is written may contain a terminal's escape codes */
} ec_listener;

#endif
