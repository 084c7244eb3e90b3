#include "jobs/sequence.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "jobs/frame_job.h"
#include "jobs/frames.h"
#include "jobs/render_job.h"
#include "report/json.h"
#include "store/identity_text.h"
#include "gltf/reader.h"

typedef struct sequence {
    const ec_listener *listener;
    const ec_render_request *request;
    ec_ranks *ranks;            /* the other processes of an MPI job; NULL: none */
    const ec_given_options *given;
    ec_identity identity;       /* common to all frames */
    ec_frame_share *share;
    ec_frame_state *states;     /* by frame, as found at the beginning */
    uint32_t count, rendered, skipped, failed;
} sequence;

static ec_result outputs_of(const sequence *s, uint32_t frame, ec_outputs *outputs, ec_error *err)
{
    const ec_render_request *r = s->request;
    outputs->count = 0;
    if (r->outputs.count) return ec_frame_outputs(&r->outputs, frame, s->count > 1, outputs, err);
    EC_TRY(ec_outputs_add_named(outputs, r->scene, err, ".%04u.exr", frame));
    return ec_outputs_add_named(outputs, r->scene, err, ".%04u.png", frame);
}

static ec_scene_choice choice_of(const sequence *s, uint32_t frame)
{
    ec_scene_choice choice = s->request->choice;
    const double at = ec_frame_moment(s->request, frame);
    choice.frame = true;
    if (!(s->request->frames.fps > 0)) return choice;
    choice.animated = true;
    choice.at = at;
    choice.opens += at; /* the shutter is relative to the frame's time */
    choice.closes += at;
    return choice;
}

/* Checks names, folders and existing files before anything is rendered. */
static ec_result look_around(sequence *s, ec_inputs *inputs, ec_error *err)
{
    const ec_render_request *r = s->request;
    const ec_log *log = &s->listener->log;
    char difference[PATH_MAX + 1400];
    ec_outputs outputs;
    ec_identity identity;
    uint32_t others = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        uint32_t frame = ec_frame_number(&r->frames, i);
        EC_TRY(outputs_of(s, frame, &outputs, err));
        ec_frame_identify(&s->identity, r, frame, &identity);
        s->states[i] = ec_frame_look(&outputs, &identity, difference, sizeof difference);
        if (s->states[i] != EC_FRAME_DONE) EC_TRY(ec_outputs_check(&outputs, inputs, err));
        if (s->states[i] == EC_FRAME_DAMAGED) ec_warn(log, "%s: frame %u is rendered again", difference, frame);
        if (s->states[i] == EC_FRAME_OTHER && !r->overwrite && others++ == 0) ec_fail(err, "%s", difference);
    }
    if (!others) return EC_OK;
    if (others > 1) ec_fail_more(err, " (%u frames in all)", others);
    ec_fail_more(err, "; --overwrite replaces frames that are not of this sequence, -o names other files");
    return EC_FAILED;
}

static ec_result tell_json(const ec_listener *listener, cJSON *object, ec_error *err)
{
    EC_TRY(ec_json_print(object, listener->to, err));
    return listener->report(listener->user, err);
}

/* Reports a frame without a new picture. failure: why; NULL: it was skipped. */
static ec_result tell_frame(const sequence *s, uint32_t frame, const char *failure, const ec_outputs *outputs, ec_error *err)
{
    if (!s->request->json) return EC_OK;
    cJSON *object = cJSON_CreateObject();
    EC_JSON(object, EC_WHOLE("frame", frame), EC_REAL("frame_seconds", ec_frame_moment(s->request, frame)),
            EC_STRING("state", failure ? "failed" : "skipped"));
    if (s->request->orbit) EC_JSON(object, EC_REAL("frame_degrees", ec_frame_turn(s->request, frame)));
    if (failure) ec_json_text(object, "error", failure);
    cJSON *names = cJSON_AddArrayToObject(object, "outputs");
    for (int i = 0; i < outputs->count; i++) ec_json_text(names, NULL, outputs->file[i].path);
    return tell_json(s->listener, object, err);
}

/* Renders a frame. *stopped: the listener ended it before it was done, and nothing of it is written. */
static ec_result render_frame(sequence *s, ec_render_request *request, uint32_t i, bool *stopped, ec_error *err)
{
    uint32_t frame = ec_frame_number(&s->request->frames, i);
    double start = ec_now();
    ec_identity identity;
    ec_frame_identify(&s->identity, s->request, frame, &identity);
    char *words = ec_identity_write(&identity), *command = ec_frame_command(s->given, s->request, &request->outputs, frame);
    ec_render_job job = {.request = request, .listener = s->listener, .command = command, .ranks = s->ranks, .share = s->share,
                         .frame = {.number = frame, .place = i + 1, .count = s->count,
                                   .seconds = ec_frame_moment(s->request, frame), .turns = s->request->orbit > 0, .degrees = request->turn, .job = words}};
    ec_result result = words && command ? EC_OK : ec_fail(err, "out of memory");
    if (result == EC_OK) result = ec_render_job_load(&job, err);
    if (result == EC_OK) result = ec_render_job_run(&job, err);
    *stopped = s->listener->should_stop(s->listener->user) && (result != EC_OK || !strcmp(job.stats.stopped_by, "user"));
    if (result == EC_OK && !*stopped) result = ec_render_job_deliver(&job, start, err);
    ec_render_job_free(&job);
    free(words);
    free(command);
    return result;
}

static ec_result take_frame(sequence *s, uint32_t i, bool *stopped, ec_error *err)
{
    uint32_t frame = ec_frame_number(&s->request->frames, i);
    ec_render_request *request = malloc(sizeof *request); /* what is found out for a frame, such as its size, is not for the others */
    if (!request) return ec_fail(err, "out of memory");
    *request = *s->request;
    request->choice = choice_of(s, frame);
    request->turn = ec_frame_turn(s->request, frame);
    if (request->seed_is_frame) request->options.seed = frame;
    ec_error why = {0};
    ec_result told = EC_OK, result = outputs_of(s, frame, &request->outputs, &why);
    if (s->states[i] == EC_FRAME_DONE) {
        s->skipped++;
        ec_frame_share_picture(s->share, &request->outputs);
        told = tell_frame(s, frame, NULL, &request->outputs, err);
    } else {
        if (result == EC_OK) result = render_frame(s, request, i, stopped, &why);
        if (result == EC_OK && !*stopped) {
            s->rendered++;
            ec_frame_share_picture(s->share, &request->outputs);
        }
        if (result != EC_OK && !*stopped) {
            ec_tell(&s->listener->log, EC_FAILURE, "frame %u: %s", frame, why.text);
            s->failed++;
            told = tell_frame(s, frame, why.text, &request->outputs, err);
            ec_frame_share_close(s->share); /* a device that failed may have lost buffers: the next frame opens it anew */
        }
    }
    free(request);
    return told;
}

static ec_result tell_all(const sequence *s, double seconds, ec_error *err)
{
    if (!s->request->json) return EC_OK;
    cJSON *object = cJSON_CreateObject();
    EC_JSON(object, EC_WHOLE("frames", s->count), EC_WHOLE("rendered", s->rendered), EC_WHOLE("skipped", s->skipped), EC_WHOLE("failed", s->failed),
            EC_REAL("total_seconds", seconds));
    return tell_json(s->listener, object, err);
}

static ec_result conclude(const sequence *s, bool stopped, double start, ec_error *err)
{
    uint32_t there = s->rendered + s->skipped;
    EC_TRY(tell_all(s, ec_now() - start, err));
    if (s->skipped) ec_say(&s->listener->log, "%u of %u frames already existed", s->skipped, s->count);
    if (stopped)
        return ec_fail(err, "interrupted: %u of %u frames are done; the same command renders the others", there,
                       s->count);
    if (s->failed)
        return ec_fail(err, "%u of %u frames failed; once that is fixed, the same command renders only those",
                       s->failed, s->count);
    return EC_OK;
}

static ec_result begin(sequence *s, ec_error *err)
{
    const ec_log *log = &s->listener->log;
    const ec_render_request *r = s->request;
    ec_scene_choice first = choice_of(s, r->frames.first);
    ec_outputs outputs;
    char files[65];
    EC_TRY(outputs_of(s, r->frames.first, &outputs, err)); /* reports invalid patterns before the file is read */
    EC_TRY(ec_animation_open(r->scene, &first, &s->share->animation, log, err));
    if (r->ground != EC_GROUND_NONE) EC_TRY(ec_animation_find_span(s->share->animation, &first, err));
    ec_animation_digest(s->share->animation, files);
    EC_TRY(ec_frames_identify(s->given, r, files, &s->identity, err));
    ec_inputs inputs = {.scene = r->scene, .files = &r->environment, .file_count = 1};
    ec_result result = look_around(s, &inputs, err);
    ec_inputs_free(&inputs);
    return result;
}

static ec_result render_all(sequence *s, double start, ec_error *err)
{
    bool stopped = false;
    EC_TRY(begin(s, err));
    for (uint32_t i = 0; i < s->count && !stopped; i++) {
        EC_TRY(take_frame(s, i, &stopped, err));
        stopped |= s->listener->should_stop(s->listener->user) && i + 1 < s->count;
    }
    return conclude(s, stopped, start, err);
}

ec_result ec_frames_render(const ec_listener *listener, const ec_render_request *request, ec_ranks *ranks,
                           const ec_given_options *given, ec_frame_share *share, double start, ec_error *err)
{
    sequence s = {.listener = listener, .request = request, .ranks = ranks, .given = given, .share = share,
                  .count = ec_frame_count(&request->frames)};
    s.states = calloc(s.count, sizeof *s.states);
    ec_result result = s.states ? render_all(&s, start, err) : ec_fail(err, "out of memory for %u frames", s.count);
    ec_frame_share_leave(share);
    free(s.states);
    return result;
}
