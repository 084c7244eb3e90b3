#include "jobs/series.h"

#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/sha256.h"
#include "base/text.h"
#include "image/image.h"
#include "jobs/frame_job.h"
#include "jobs/render_job.h"
#include "jobs/sequence.h"
#include "jobs/sheet.h"
#include "report/json.h"
#include "store/identity_text.h"

typedef struct series {
    const ec_listener *listener;  /* passes messages on with the entry's name in front */
    ec_listener named;
    const ec_log *log;            /* the caller's */
    const ec_render_request *all; /* the request for all pictures */
    ec_ranks *ranks;
    ec_entries *entries;          /* those that fail get a why_not */
    double start;
    ec_frame_share share;
    bool *blanks;                 /* by entry: the picture shows no surface */
    uint32_t current;             /* the entry being rendered, from 1; 0: none */
    uint32_t count, place;        /* within the shard */
    uint32_t rendered, skipped, failed, blank;
} series;

/* Puts the scene's name in front of notes and warnings, if there are several scenes. */
static void write_named(void *user, ec_severity severity, const char *text)
{
    const series *s = user;
    const char *name = s->current && s->entries->count > 1 ? s->entries->list[s->current - 1].name : "";
    const bool names = *name && (severity == EC_NOTE || severity == EC_WARNING) && strncmp(text, name, strlen(name));
    ec_tell(s->log, severity, "%s%s%s", names ? name : "", names ? ": " : "", text);
}

static bool is_of_shard(const series *s, uint32_t i) { return !s->all->shard_count || i % s->all->shard_count + 1 == s->all->shard; }

static ec_result settle(const ec_entry *entry, ec_render_request *r, ec_error *err)
{
    bool given[EC_OPTIONS_MAX] = {false};
    ec_render_request_start(r);
    EC_TRY(ec_given_apply(&entry->given, ec_render_rows, ec_render_row_count, r, given, err));
    r->scene = entry->scene;
    EC_TRY(ec_render_request_settle(r, ec_render_rows, ec_render_row_count, given, err));
    return r->outputs.count || r->frames.given ? EC_OK : ec_outputs_add_default(&r->outputs, r->scene, err);
}

/* Checks the outputs of all entries before anything is rendered; sequences check their frames themselves. */
static ec_result look_around(series *s, ec_render_request *r, ec_error *err)
{
    for (uint32_t i = 0; i < s->entries->count; i++) {
        const ec_entry *entry = &s->entries->list[i];
        if (!is_of_shard(s, i)) continue;
        s->count++;
        if (entry->why_not) continue;
        EC_TRY(settle(entry, r, err));
        ec_inputs inputs = {.scene = r->scene, .files = &r->environment, .file_count = 1};
        ec_result result = r->frames.given ? EC_OK : ec_outputs_check(&r->outputs, &inputs, err);
        ec_inputs_free(&inputs);
        EC_TRY(result);
    }
    return s->all->sheet ? ec_image_check_writable(s->all->sheet, err) : EC_OK;
}

static ec_result find_devices(series *s, ec_error *err)
{
    ec_render_request *request = malloc(sizeof *request);
    if (!request) return ec_fail(err, "out of memory");
    *request = *s->all;
    ec_render_job job = {.request = request, .listener = s->listener, .ranks = s->ranks, .takes_several = true};
    ec_result result = ec_render_job_find_devices(&job, err);
    memcpy(s->share.devices, job.devices, sizeof job.devices);
    memcpy(s->share.device_indices, job.device_indices, sizeof job.device_indices);
    s->share.device_count = job.device_count;
    s->share.device_why = job.device_why;
    free(request);
    return result;
}

/* Computes a digest of all files of a scene; missing files are reported when it is loaded. */
static void digest_scene(const char *scene, char hex[EC_SHA256_TEXT])
{
    ec_scene_files files = {0};
    ec_error ignored;
    ec_sha256 all;
    ec_sha256_begin(&all);
    ec_scene_files_list(scene, &files);
    for (uint32_t i = 0; i < files.count; i++) {
        const bool is_there = access(files.paths[i], R_OK) == 0 && ec_image_check_regular(files.paths[i], &ignored) == EC_OK;
        char one[EC_SHA256_TEXT] = "-";
        if (is_there) (void)ec_sha256_file(files.paths[i], one);
        ec_sha256_add(&all, one, strlen(one));
    }
    ec_scene_files_free(&files);
    ec_sha256_end_text(&all, hex);
}

static ec_result tell_json(const series *s, cJSON *object, ec_error *err)
{
    EC_TRY(ec_json_print(object, s->listener->to, err));
    return s->listener->report(s->listener->user, err);
}

/* Reports a picture that was not rendered. failure: why; NULL: it was skipped. */
static ec_result tell(const series *s, const ec_entry *entry, const char *failure, const ec_outputs *outputs, ec_error *err)
{
    if (!s->all->json) return EC_OK;
    cJSON *object = cJSON_CreateObject();
    EC_JSON(object, EC_STRING("name", entry->name), EC_STRING("state", failure ? "failed" : "skipped"));
    if (failure) ec_json_text(object, "error", failure);
    cJSON *names = cJSON_AddArrayToObject(object, "outputs");
    for (int i = 0; i < outputs->count; i++) ec_json_text(names, NULL, outputs->file[i].path);
    return tell_json(s, object, err);
}

static ec_result render(series *s, uint32_t i, ec_render_request *r, const ec_identity *identity, bool *stopped, ec_error *err)
{
    const double start = ec_now();
    const ec_entry *entry = &s->entries->list[i];
    char *words = ec_identity_write(identity), *command = ec_frame_command(&entry->given, r, &r->outputs, 0);
    ec_render_job job = {.request = r, .listener = s->listener, .command = command, .ranks = s->ranks, .share = &s->share,
                         .frame = {.name = entry->name, .place = s->place, .count = s->count, .job = words}};
    ec_result result = words && command ? EC_OK : ec_fail(err, "out of memory");
    if (result == EC_OK) result = ec_render_job_load(&job, err);
    if (result == EC_OK && (result = ec_render_job_run(&job, err)) != EC_OK) ec_frame_share_close(&s->share); /* the device may have failed */
    *stopped = s->listener->should_stop(s->listener->user) && (result != EC_OK || !strcmp(job.stats.stopped_by, "user"));
    if (result == EC_OK && !*stopped) result = ec_render_job_deliver(&job, start, err);
    s->blank += s->blanks[i] = result == EC_OK && job.is_blank;
    ec_render_job_free(&job);
    free(words);
    free(command);
    return result;
}

static ec_result take_picture(series *s, uint32_t i, ec_render_request *r, bool *stopped, ec_error *err)
{
    const ec_entry *entry = &s->entries->list[i];
    char files[EC_SHA256_TEXT], difference[PATH_MAX + 1400];
    ec_identity identity;
    digest_scene(r->scene, files);
    EC_TRY(ec_frames_identify(&entry->given, r, files, &identity, err));
    if (ec_frame_look(&r->outputs, &identity, difference, sizeof difference) == EC_FRAME_DONE) {
        s->skipped++;
        EC_TRY(tell(s, entry, NULL, &r->outputs, err));
    } else {
        EC_TRY(render(s, i, r, &identity, stopped, err));
        if (*stopped) return EC_OK;
        s->rendered++;
    }
    ec_frame_share_picture(&s->share, &r->outputs);
    return EC_OK;
}

static ec_result take_frames(series *s, uint32_t i, const ec_render_request *r, ec_error *err)
{
    EC_TRY(ec_frames_render(s->listener, r, s->ranks, &s->entries->list[i].given, &s->share, s->count > 1 ? ec_now() : s->start, err));
    s->rendered++;
    return EC_OK;
}

/* Reports a failure: once when it happens, once at the end. */
static void say_failure(const series *s, const ec_entry *entry, const char *why, ec_severity severity)
{
    const bool is_named = !strncmp(why, entry->name, strlen(entry->name));
    ec_tell(&s->listener->log, severity, "%s%s%s", is_named ? "" : entry->name, is_named ? "" : ": ", why);
}

static ec_result take(series *s, uint32_t i, ec_render_request *r, bool *stopped, ec_error *err)
{
    ec_entry *entry = &s->entries->list[i];
    ec_error why = {0};
    s->place++;
    s->current = i + 1;
    ec_result result = entry->why_not ? ec_fail(&why, "%s", entry->why_not) : settle(entry, r, &why);
    if (result == EC_OK && r->frames.given) result = take_frames(s, i, r, &why);
    else if (result == EC_OK) result = take_picture(s, i, r, stopped, &why);
    if (result == EC_OK || *stopped) return EC_OK;
    if (!entry->why_not) entry->why_not = strdup(why.text);
    if (s->entries->count == 1) {
        *err = why;
        return result;
    }
    say_failure(s, entry, why.text, EC_STATUS);
    s->failed++;
    return tell(s, entry, why.text, &r->outputs, err);
}

/* Lists names of blank entries, separated by commas, as many as fit. */
static void list_blanks(const series *s, char *text, size_t size)
{
    size_t used = 0;
    uint32_t named = 0;
    for (uint32_t i = 0; i < s->entries->count && used + 100 < size; i++)
        if (s->blanks[i]) used += (size_t)snprintf(text + used, size - used, "%s%.*s", named++ ? ", " : "", EC_CUT(s->entries->list[i].name, 80));
    if (named < s->blank) snprintf(text + used, size - used, " and %u more", s->blank - named);
}

static ec_result conclude(const series *s, bool stopped, ec_error *err)
{
    const ec_log *log = &s->listener->log;
    char names[900] = "";
    if (s->all->json && s->entries->count > 1) {
        cJSON *object = cJSON_CreateObject();
        EC_JSON(object, EC_WHOLE("pictures", s->count), EC_WHOLE("rendered", s->rendered), EC_WHOLE("skipped", s->skipped), EC_WHOLE("failed", s->failed),
                EC_REAL("total_seconds", ec_now() - s->start));
        EC_TRY(tell_json(s, object, err));
    }
    if (s->skipped) ec_say(log, "%u of %u pictures already existed", s->skipped, s->count);
    list_blanks(s, names, sizeof names);
    if (s->blank && s->count > 1) ec_warn(log, "%u of %u pictures show no surface, as warned above: %s", s->blank, s->count, names);
    for (uint32_t i = 0; i < s->entries->count; i++)
        if (s->entries->list[i].why_not && is_of_shard(s, i)) say_failure(s, &s->entries->list[i], s->entries->list[i].why_not, EC_FAILURE);
    if (stopped)
        return ec_fail(err, "interrupted: %u of %u pictures are done; the same command renders the others", s->rendered + s->skipped, s->count);
    if (s->failed)
        return ec_fail(err, "%u of %u pictures failed; once that is fixed, the same command renders only those", s->failed, s->count);
    return EC_OK;
}

static ec_result render_all(series *s, ec_render_request *r, ec_error *err)
{
    bool stopped = false;
    EC_TRY(look_around(s, r, err));
    EC_TRY(find_devices(s, err));
    for (uint32_t i = 0; i < s->entries->count && !stopped; i++) {
        if (!is_of_shard(s, i)) continue;
        EC_TRY(take(s, i, r, &stopped, err));
        stopped |= s->listener->should_stop(s->listener->user) && s->place < s->count;
    }
    s->current = 0;
    if (s->all->sheet) EC_TRY(ec_sheet_write(s->all->sheet, s->share.pictures.list, s->share.pictures.count, err));
    return conclude(s, stopped, err);
}

ec_result ec_series_render(const ec_listener *listener, const ec_render_request *request, ec_ranks *ranks, ec_entries *entries, double start,
                           ec_error *err)
{
    series s = {.named = *listener, .log = &listener->log, .all = request, .ranks = ranks, .entries = entries, .start = start};
    s.named.log = (ec_log){write_named, &s};
    s.listener = &s.named;
    ec_render_request *room = malloc(sizeof *room);
    s.blanks = calloc(entries->count + 1, sizeof *s.blanks);
    ec_result result = room && s.blanks ? render_all(&s, room, err) : ec_fail(err, "out of memory for %u pictures", entries->count);
    ec_frame_share_free(&s.share);
    free(s.blanks);
    free(room);
    return result;
}
