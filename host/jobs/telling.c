#include "jobs/telling.h"

#include <stdlib.h>

#include "report/error_text.h"
#include "report/json.h"

ec_result ec_telling_begin(ec_telling *t, const ec_listener *listener, ec_error *err)
{
    *t = (ec_telling){.listener = listener};
    t->to = open_memstream(&t->text, &t->size);
    return t->to ? EC_OK : ec_fail(err, "out of memory for a report");
}

ec_result ec_telling_end(ec_telling *t, ec_result result, ec_error *err)
{
    const bool is_whole = !ferror(t->to);
    if ((fclose(t->to) != 0 || !is_whole) && result == EC_OK) result = ec_fail(err, "out of memory for a report");
    if (result == EC_OK && t->size && t->listener->report) result = t->listener->report(t->listener->user, t->text, t->size, err);
    free(t->text);
    return result;
}

static ec_result tell_json(const ec_listener *listener, cJSON *object, ec_error *err)
{
    ec_telling t;
    EC_TRY(ec_telling_begin(&t, listener, err));
    return ec_telling_end(&t, ec_json_print(object, t.to, err), err);
}

ec_result ec_tell_render(const ec_listener *listener, const ec_render_request *request, const ec_render_report *report, ec_error *err)
{
    ec_telling t;
    ec_result result = EC_OK;
    char summary[EC_ERROR_TEXT + 128];
    EC_TRY(ec_telling_begin(&t, listener, err));
    if (request->json) {
        ec_render_report_summary(report, summary, sizeof summary);
        ec_say(&listener->log, "%s", summary);
        result = ec_render_report_json(report, t.to, err);
    } else if (!request->quiet) {
        (report->frame ? ec_frame_report_text : ec_render_report_text)(report, t.to);
    }
    return ec_telling_end(&t, result, err);
}

ec_result ec_tell_frame(const ec_listener *listener, const ec_render_request *request, uint32_t frame, const char *failure, const ec_outputs *outputs, ec_error *err)
{
    if (!request->json) return EC_OK;
    cJSON *object = cJSON_CreateObject();
    ec_json_whole(object, "frame", frame);
    ec_json_real(object, "frame_seconds", ec_frame_seconds(&request->frames, frame));
    ec_json_text(object, "state", failure ? "failed" : "skipped");
    if (failure) ec_json_text(object, "error", failure);
    cJSON *names = cJSON_AddArrayToObject(object, "outputs");
    for (int i = 0; i < outputs->count; i++) ec_json_text(names, NULL, outputs->file[i].path);
    return tell_json(listener, object, err);
}

ec_result ec_tell_sequence(const ec_listener *listener, const ec_render_request *request, const ec_sequence_told *told, ec_error *err)
{
    if (!request->json) return EC_OK;
    cJSON *object = cJSON_CreateObject();
    ec_json_whole(object, "frames", told->count);
    ec_json_whole(object, "rendered", told->rendered);
    ec_json_whole(object, "skipped", told->skipped);
    ec_json_whole(object, "failed", told->failed);
    ec_json_real(object, "total_seconds", told->seconds);
    return tell_json(listener, object, err);
}
