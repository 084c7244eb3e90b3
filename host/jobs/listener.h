/* Who hears of a job while it runs, and may stop it. */
#ifndef EC_JOBS_LISTENER_H
#define EC_JOBS_LISTENER_H

#include "render/render.h"

/* How far a job is that does other things than one render. */
typedef struct ec_step {
    const char *doing;
    uint32_t done, count;
    double seconds, seconds_left, fraction; /* seconds_left < 0: not known */
} ec_step;

/* Any function may be NULL: that event is then ignored, and nothing stops the job. All are called from the thread that runs the job. */
typedef struct ec_listener {
    void *user;
    ec_log log;                                                    /* has this user of its own */
    /* A kill would lose something from now on. has_progress: it is told up to the end; options: of the render that it is of, or NULL. */
    void (*begin)(void *user, const ec_render_options *options, bool has_progress);
    bool (*progress)(void *user, const ec_progress *progress);     /* false: stop and keep what there is */
    bool (*step)(void *user, const ec_step *step);                 /* likewise */
    void (*end)(void *user);                                       /* after the last progress */
    bool (*should_stop)(void *user);
    void (*hint)(void *user, const char *line);                    /* what to say should the job be stopped from outside */
    ec_result (*report)(void *user, const char *text, size_t size, ec_error *err); /* what came of the job, or of a part; else than EC_OK ends it */
    bool bold;                                                     /* reports may have the escape codes of a terminal */
} ec_listener;

void ec_listener_begin(const ec_listener *listener, const ec_render_options *options, bool has_progress);
bool ec_listener_progress(void *listener, const ec_progress *progress); /* an ec_progress_fn */
bool ec_listener_step(const ec_listener *listener, const ec_step *step);
void ec_listener_end(const ec_listener *listener);
bool ec_listener_should_stop(const ec_listener *listener);
void ec_listener_hint(const ec_listener *listener, const char *line);

#endif
