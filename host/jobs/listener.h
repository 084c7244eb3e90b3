/* Who hears of a job while it runs, and may stop it: a program, a window, a caller of the library. */
#ifndef EC_JOBS_LISTENER_H
#define EC_JOBS_LISTENER_H

#include "jobs/outputs.h"
#include "render/render.h"
#include "report/render_report.h"

typedef enum ec_frame_end { EC_FRAME_SKIPPED, EC_FRAME_FAILED } ec_frame_end;

/* A frame of a sequence without a new picture. */
typedef struct ec_frame_told {
    uint32_t number;
    double seconds;
    ec_frame_end end;
    const char *error; /* NULL: it was skipped */
    const ec_outputs *outputs;
} ec_frame_told;

typedef struct ec_sequence_told {
    uint32_t count, rendered, skipped, failed;
    double seconds;
} ec_sequence_told;

/* Any function may be NULL: that event is then ignored, and nothing stops the job. All are called from the thread that runs the job. A result other
 * than EC_OK ends the job. */
typedef struct ec_listener {
    void *user;
    ec_log log;                                                    /* has this user of its own */
    void (*begin)(void *user, const ec_render_options *options);   /* samples are about to be taken: a kill would lose them */
    bool (*progress)(void *user, const ec_progress *progress);     /* false: stop and keep what there is */
    void (*end)(void *user);                                       /* after the last progress */
    bool (*should_stop)(void *user);
    void (*hint)(void *user, const char *line);                    /* what to say should the job be stopped from outside */
    ec_result (*rendered)(void *user, const ec_render_report *report, ec_error *err); /* a picture, whose files are written */
    ec_result (*frame)(void *user, const ec_frame_told *frame, ec_error *err);
    ec_result (*sequence)(void *user, const ec_sequence_told *sequence, ec_error *err);
} ec_listener;

void ec_listener_begin(const ec_listener *listener, const ec_render_options *options);
bool ec_listener_progress(void *listener, const ec_progress *progress); /* an ec_progress_fn */
void ec_listener_end(const ec_listener *listener);
bool ec_listener_should_stop(const ec_listener *listener);
void ec_listener_hint(const ec_listener *listener, const char *line);
ec_result ec_listener_rendered(const ec_listener *listener, const ec_render_report *report, ec_error *err);
ec_result ec_listener_frame(const ec_listener *listener, const ec_frame_told *frame, ec_error *err);
ec_result ec_listener_sequence(const ec_listener *listener, const ec_sequence_told *sequence, ec_error *err);

#endif
