/* What came of a job, in words or as JSON, goes to its listener as one text. */
#ifndef EC_JOBS_TELLING_H
#define EC_JOBS_TELLING_H

#include <stdio.h>

#include "jobs/listener.h"
#include "jobs/render_request.h"
#include "report/render_report.h"

typedef struct ec_telling {
    const ec_listener *listener;
    FILE *to; /* what is put here is told */
    char *text;
    size_t size;
} ec_telling;
ec_result ec_telling_begin(ec_telling *telling, const ec_listener *listener, ec_error *err);

/* Frees it; tells nothing where `result`, which is handed on, is a failure, or where nothing was put. */
ec_result ec_telling_end(ec_telling *telling, ec_result result, ec_error *err);

/* A picture, as the request wants it told. */
ec_result ec_tell_render(const ec_listener *listener, const ec_render_request *request, const ec_render_report *report, ec_error *err);

/* A frame without a new picture, where the request wants JSON. failure: why; NULL: it was skipped. */
ec_result ec_tell_frame(const ec_listener *listener, const ec_render_request *request, uint32_t frame, const char *failure, const ec_outputs *outputs, ec_error *err);

typedef struct ec_sequence_told {
    uint32_t count, rendered, skipped, failed;
    double seconds;
} ec_sequence_told;
ec_result ec_tell_sequence(const ec_listener *listener, const ec_render_request *request, const ec_sequence_told *told, ec_error *err);

#endif
