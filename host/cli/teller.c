#include "cli/teller.h"

#include <stdio.h>

#include "cli/stop.h"
#include "report/error_text.h"
#include "report/json.h"

static void begin(void *user, const ec_render_options *options)
{
    ec_teller *t = user;
    t->progress = (ec_progress_view){.console = t->console, .options = options};
    ec_stop_catch_signals(ec_console_wants_progress(t->console));
}

static bool show(void *user, const ec_progress *progress)
{
    ec_stop_ignore_file_size();
    return ec_progress_show(&((ec_teller *)user)->progress, progress);
}

static void end(void *user)
{
    ec_stop_ignore_file_size();
    ec_console_erase(((ec_teller *)user)->console);
}

static bool should_stop(void *user)
{
    (void)user;
    return ec_stop_requested();
}

static void hint(void *user, const char *line)
{
    ec_teller *t = user;
    ec_stop_hint(NULL);
    snprintf(t->hint, sizeof t->hint, "%s", line);
    ec_stop_hint(t->hint);
}

static ec_result rendered(void *user, const ec_render_report *report, ec_error *err)
{
    const ec_teller *t = user;
    if (t->json) {
        char summary[EC_ERROR_TEXT + 128];
        ec_render_report_summary(report, summary, sizeof summary);
        ec_console_say(t->console, "%s", summary);
        return ec_render_report_json(report, stdout, err);
    }
    if (!t->quiet && !report->frame) ec_render_report_text(report, stdout);
    if (!t->quiet && report->frame) ec_frame_report_text(report, stdout);
    return EC_OK;
}

static ec_result frame(void *user, const ec_frame_told *told, ec_error *err)
{
    static const char *const ends[] = {[EC_FRAME_SKIPPED] = "skipped", [EC_FRAME_FAILED] = "failed"};
    const ec_teller *t = user;
    if (!t->json) return EC_OK;
    cJSON *object = cJSON_CreateObject();
    ec_json_whole(object, "frame", told->number);
    ec_json_real(object, "frame_seconds", told->seconds);
    ec_json_text(object, "state", ends[told->end]);
    if (told->error) ec_json_text(object, "error", told->error);
    cJSON *outputs = cJSON_AddArrayToObject(object, "outputs");
    for (int i = 0; i < told->outputs->count; i++) ec_json_text(outputs, NULL, told->outputs->file[i].path);
    return ec_json_print(object, stdout, err);
}

static ec_result sequence(void *user, const ec_sequence_told *told, ec_error *err)
{
    const ec_teller *t = user;
    if (!t->json) return EC_OK;
    cJSON *object = cJSON_CreateObject();
    ec_json_whole(object, "frames", told->count);
    ec_json_whole(object, "rendered", told->rendered);
    ec_json_whole(object, "skipped", told->skipped);
    ec_json_whole(object, "failed", told->failed);
    ec_json_real(object, "total_seconds", told->seconds);
    return ec_json_print(object, stdout, err);
}

ec_listener ec_teller_listener(ec_teller *t)
{
    return (ec_listener){.user = t, .log = ec_console_log(t->console), .begin = begin, .progress = show, .end = end, .should_stop = should_stop,
                         .hint = hint, .rendered = rendered, .frame = frame, .sequence = sequence};
}
