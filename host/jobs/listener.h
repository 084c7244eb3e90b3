/* Who hears of a job while it runs, and may stop it. */
#ifndef EC_JOBS_LISTENER_H
#define EC_JOBS_LISTENER_H

#include <stdio.h>

#include "render/render.h"

/* How far a job is that does other things than one render. */
typedef struct ec_step {
    const char *doing;
    uint32_t done, count;
    double seconds, seconds_left, fraction; /* seconds_left < 0: not known */
} ec_step;

/* All functions are there, and called from the thread that runs the job. */
typedef struct ec_listener {
    void *user;
    ec_log log;
    /* A kill would lose something from now on. has_progress: it is told up to the end; options: of the render that it is of, or NULL. */
    void (*begin)(void *user, const ec_render_options *options, bool has_progress);
    bool (*progress)(void *user, const ec_progress *progress);     /* false: stop and keep what there is */
    bool (*step)(void *user, const ec_step *step);                 /* likewise */
    void (*end)(void *user);                                       /* after the last progress */
    bool (*should_stop)(void *user);
    void (*hint)(void *user, const char *line);                    /* what to say should the job be stopped from outside */
    FILE *to;                                                      /* what came of the job, or of a part, is put here, */
    ec_result (*report)(void *user, ec_error *err);                /* and told by this, or when the job ends. Else than EC_OK ends the job */
    bool bold;                                                     /* what is put there may have the escape codes of a terminal */
} ec_listener;

#endif
