/* The course of a render: the batch that it starts from, and the checkpoints and slices that it keeps on the way. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "cl/workarounds.h"
#include "jobs/given.h"
#include "jobs/defaults.h"
#include "jobs/render_job.h"
#include "jobs/snapshot.h"
#include "jobs/write_report.h"

/* Returns the value of --adaptive with which a command with other limits allots samples in the same way; NULL: none needed. */
static const char *adaptive_word(const ec_render_options *o, const ec_given_options *given)
{
    bool is_told = o->adaptive == (o->error_target > 0);
    for (int i = 0; i < given->count; i++)
        is_told |= !strcmp(given->list[i].option, "adaptive") && (!given->list[i].value || strcmp(given->list[i].value, "auto"));
    return is_told ? NULL : o->adaptive ? "on" : "off";
}

/* Makes the command that would render the whole picture without a break: the job's, with the present options instead of those that they replace. */
static ec_result make_command(ec_render_job *job, const ec_given_options *now, ec_error *err)
{
    const ec_option *rows = ec_render_rows;
    const int count = ec_render_row_count;
    uint32_t replaced = EC_OPTION_KEEPING;
    char *scene = (char *)(uintptr_t)job->request->scene;
    ec_given_options whole = {0};
    ec_words words = {0};
    ec_result result;
    for (int i = 0; i < now->count; i++) replaced |= ec_render_row(now->list[i].option)->uses & (EC_OPTION_LIMIT | EC_OPTION_OUTPUT);
    EC_TRY_CLEANUP(ec_given_add_all(&whole, &job->before, rows, count, replaced, err));
    EC_TRY_CLEANUP(ec_given_add_all(&whole, now, rows, count, EC_OPTION_KEEPING, err));
    const char *adaptive = adaptive_word(&job->request->options, &whole);
    if (adaptive) EC_TRY_CLEANUP(ec_given_add(&whole, "adaptive", adaptive, err));
    EC_TRY_CLEANUP(ec_words_make(&words, "render", &scene, 1, &whole, rows, count, err));
    job->command = job->whole_command = ec_command_line(words.count, words.list);
    if (!job->command) result = ec_fail(err, "out of memory");
cleanup:
    ec_words_free(&words);
    ec_given_free(&whole);
    return result;
}

ec_result ec_render_job_take_up(ec_render_job *job, const ec_given_options *now, ec_error *err)
{
    const char *path = job->request->resume;
    EC_TRY(ec_store_read(path, &job->stored, err));
    if (job->stored.job.merged)
        return ec_fail(err, "cannot continue from '%s': it was merged; render what is missing with --samples, and merge that", path);
    EC_TRY(ec_render_request_resume(&job->stored.job, now, job->request, &job->before, err));
    EC_TRY(make_command(job, now, err));
    job->job.argc = job->stored.job.argc;
    job->job.argv = job->stored.job.argv;
    job->job.folder = job->stored.job.folder;
    const ec_render_request *r = job->request;
    const uint32_t first = r->has_slice ? r->options.slice_first : 0, end = r->has_slice ? r->options.slice_end : 0;
    if (first != job->stored.job.first || end != job->stored.job.end)
        return ec_fail(err, "cannot continue from '%s': its samples are not --samples %u:%u; leave that out", path,
                       r->slice_first, r->slice_end);
    return EC_OK;
}

/* Warns if a checkpoint of this very render is about to be overwritten: one begun anew by mistake would cost hours of samples. Files of other renders
 * are replaced like any output. */
static void warn_of_older(const ec_render_job *job, const ec_log *log)
{
    const char *path = job->request->checkpoint;
    char difference[1200];
    ec_stored old = {0};
    uint32_t first;
    if (path && ec_store_peek(path, &old, &first) &&
        !ec_identity_differs(&old.job.identity, &job->job.identity, difference, sizeof difference))
        ec_warn(log, "'%s' holds %llu samples per pixel of this render and will be overwritten; '--resume %s' continues it instead", path,
                (unsigned long long)ec_schedule_samples(old.film.replicates, old.film.batch_count), path);
    ec_stored_free(&old);
}

/* Checks that the checkpoint belongs to what is rendered, once that is known. */
static ec_result admit(void *user, const ec_render_stats *stats, ec_error *err)
{
    ec_render_job *job = user;
    const ec_log *log = &job->listener->log;
    char difference[1200];
    ec_identity_of(&job->request->options, &stats->content, &job->job.identity);
    if (job->request->light_groups) ec_identity_add(&job->job.identity, "--light-groups", job->request->light_groups);
    if (!job->request->resume) {
        warn_of_older(job, log);
        return EC_OK;
    }
    if (ec_identity_differs(&job->stored.job.identity, &job->job.identity, difference, sizeof difference))
        return ec_fail(err, "cannot continue from '%s': %s; use the scene, options and version that it was made with, or start anew",
                       job->request->resume, difference);
    if (!ec_layers_are_same(&job->film.layers, &job->request->options.layers))
        return ec_fail(err, "cannot continue from '%s': it lacks the layers of its own command; use an older file, or start anew", job->request->resume);
    if (strcmp(job->stored.job.device, job->device_text))
        ec_warn(log, "'%s' was rendered on %s; where that rounds differently from %s, the last bits are not those of a single run",
                job->request->resume, job->stored.job.device, job->device_text);
    return EC_OK;
}

/* Frees the scene's data, unless they are shared with the next frame of an animation, or needed for shadows. */
static void drop_scene(void *user)
{
    ec_render_job *job = user;
    if ((!job->share || !job->share->animation) && job->request->ground != EC_GROUND_SHADOW) ec_scene_drop_data(job->scene);
}

static bool keep_all(ec_render_job *job, const ec_film *film, const ec_past *past)
{
    const ec_log *log = &job->listener->log;
    ec_picture picture = {0};
    const ec_attribute attributes[] = {{.name = "eclat.command", .type = EC_ATTR_STRING, .string = job->command},
                                       {.name = "eclat.version", .type = EC_ATTR_STRING, .string = ECLAT_VERSION}};
    const ec_picture_style style = {.attributes = attributes, .attribute_count = 2, .job = &job->job, .film = film, .past = past};
    job->keep_error.text[0] = 0;
    ec_result result = ec_picture_resolve(film, false, &picture, &job->keep_error);
    if (result == EC_OK) result = ec_picture_write_exr(job->request->checkpoint, &picture, &style, &job->keep_error);
    ec_picture_free(&picture);
    job->has_kept |= result == EC_OK;
    if (result != EC_OK) ec_warn(log, "%s; the render goes on, and the checkpoint will be tried again", job->keep_error.text);
    return result == EC_OK;
}

static bool keep(void *user, const ec_film *film, const ec_past *past)
{
    ec_render_job *job = user;
    ec_error unwritten;
    if (job->request->snapshot && ec_snapshot_write(job, film, past, &unwritten) != EC_OK)
        ec_warn(&job->listener->log, "%s; the render goes on, and the snapshot will be tried again", unwritten.text);
    return !job->request->checkpoint || keep_all(job, film, past);
}

/* Writes a strip to the files. */
static ec_result take_strip(void *user, const ec_film *film, uint32_t first_row, const ec_render_stats *stats, ec_error *err)
{
    enum { ROOM = 256 }; /* bytes for how the render ended, and for counts that get more digits */
    ec_render_job *job = user;
    const char *outputs[EC_OUTPUTS_MAX];
    if (first_row == 0) {
        ec_render_report report = ec_render_job_report(job, outputs);
        report.stats = stats;
        report.replicates = ec_film_replicates(film);
        return ec_report_rows_open(&job->rows, &job->request->outputs, ec_render_channels(job->request), film, job->request->options.height, &report,
                                   ROOM, err);
    }
    ec_result result = ec_row_writer_put(job->rows, film, err);
    if (result == EC_OK) return EC_OK;
    ec_row_writer_abort(job->rows); /* no file can be written any more */
    job->rows = NULL;
    return result;
}

static ec_result look_at_clean(void *user, ec_film *film, ec_clean_look *look, ec_error *err)
{
    ec_render_job *job = user;
    EC_TRY(ec_denoise(film, job->request->options.denoise, &job->devices[0], &job->denoised, err));
    *look = job->denoised.why_not ? (ec_clean_look){INFINITY, INFINITY} : (ec_clean_look){job->denoised.best.error, job->denoised.best.high95};
    return EC_OK;
}

static bool all_round(const ec_render_job *job)
{
    bool all = true;
    for (uint32_t i = 0; i < job->device_count; i++) all &= ec_device_rounds(&job->devices[i]);
    return all;
}

ec_course ec_render_job_course(ec_render_job *job)
{
    ec_render_request *request = job->request;
    ec_device_drivers(job->devices, job->device_count, job->device_text, sizeof job->device_text);
    if (job->ranks) job->peers = ec_ranks_peers(job->ranks, request->device, job->device_text, all_round(job));
    job->job.device = job->device_text;
    job->job.spp = request->slice_of_any ? 0 : request->options.spp;
    job->job.error_target = request->options.error_target;
    job->job.time_limit = request->options.time_limit;
    request->options.identify = request->has_slice || request->checkpoint;
    const char *whole_for = job->in_memory ? "a render without output files" : ec_render_whole_for(request);
    ec_course course = {.admit = request->options.identify ? admit : NULL,
                        .loaded = drop_scene,
                        .keep = request->checkpoint || request->snapshot ? keep : NULL,
                        .strip = whole_for ? NULL : take_strip,
                        .whole_for = whole_for,
                        .clean = look_at_clean,
                        .every = request->every,
                        .most = request->capped ? EC_SAFETY_SPP : 0,
                        .peers = job->ranks ? &job->peers : NULL,
                        .user = job};
    if (request->has_slice) {
        course.first = job->job.first = request->options.slice_first;
        course.end = job->job.end = request->options.slice_end;
        course.cut = job->job.cut = request->slice_cut;
    }
    if (!request->resume) return course;
    course.past = &job->stored.past;
    course.past_is_kept = ec_same_file(request->checkpoint, request->resume);
    job->film = job->stored.film;
    job->stored.film = (ec_film){0};
    return course;
}
