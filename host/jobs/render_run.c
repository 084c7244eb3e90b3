/* Runs a job that is ready: opens its devices, and says beforehand what will be rendered. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "cl/workarounds.h"
#include "jobs/given.h"
#include "jobs/render_job.h"
#include "jobs/shadow.h"

enum { LEAST_OF_SHADOW = 16 }; /* samples per pixel: two for each replicate */

/* Returns the samples per pixel of the checkpoint; 0: none. */
static uint64_t samples_there(const ec_render_job *job)
{
    const ec_render_options *options = &job->request->options;
    return job->stored.past.samples / ((uint64_t)options->width * options->height);
}

/* Returns the most samples asked for; 0: other limits end the render. */
static uint32_t samples_asked(const ec_render_request *request)
{
    return request->has_slice ? request->slice_end - request->slice_first : request->options.spp;
}

static bool is_complete(const ec_render_job *job)
{
    const uint32_t asked = samples_asked(job->request);
    return asked && samples_there(job) >= asked;
}

/* Returns the command that resumes from the checkpoint, malloc'ed, and prints it before there is a checkpoint, since a SIGKILL leaves no time for
 * words. */
static char *say_how_to_go_on(const ec_render_job *job)
{
    char *words[] = {(char *)job->program, (char[]){"render"}, (char[]){"--resume"}, (char *)job->request->checkpoint};
    char *command = job->request->checkpoint && !is_complete(job) ? ec_command_line(4, words) : NULL;
    if (command) ec_say(&job->listener->log, "if this is interrupted, continue from the last checkpoint with: %s", command);
    return command;
}

/* Gives the hint shown on a signal: when a rank dies, mpirun ends all others, and a signal is the last that rank 0 hears of it. */
static void hint_at_resume(const ec_render_job *job, const char *command)
{
    char hint[5000];
    const char *how = job->share != NULL ? "the same command continues after what is done"
                      : command ? "continue from the last checkpoint, alone or under mpirun, with: "
                                : "with --checkpoint FILE it could be continued";
    snprintf(hint, sizeof hint, "asked to stop, as by mpirun when a rank has died; %s%s", how, command ? command : "");
    job->listener->hint(job->listener->user, hint);
}

/* Describes who renders beside the first device: ", with 3 more processes,". */
static void describe_helpers(const ec_render_job *job, char *text, size_t size)
{
    const int ranks = job->ranks ? ec_ranks_count(job->ranks) - 1 : 0;
    uint32_t queues = 0;
    int used = 0;
    for (uint32_t i = 0; i < job->device_count; i++) queues += job->devices[i].id == job->devices[0].id;
    const uint32_t more = job->device_count - queues;
    if (queues > 1) used = snprintf(text, size, " with %u queues", queues);
    if (more) used += snprintf(text + used, size - (size_t)used, " and %u more device%s", more, more > 1 ? "s" : "");
    if (ranks) snprintf(text + used, size - (size_t)used, ", with %d more process%s,", ranks, ranks > 1 ? "es" : "");
}

static void announce(const ec_render_job *job)
{
    const ec_render_options *options = &job->request->options;
    char when[32], limits[160] = "", range[128] = "", more[96] = "";
    int used = 0;
    ec_frame_when(&job->frame, when, sizeof when);
    if (options->spp) used += snprintf(limits, sizeof limits, "%u samples a pixel", options->spp);
    if (options->time_limit > 0)
        used += snprintf(limits + used, sizeof limits - (size_t)used, "%s%g s", used ? " or " : "", options->time_limit);
    if (options->error_target > 0)
        snprintf(limits + used, sizeof limits - (size_t)used, "%s%g %% error", used ? " or " : "",
                 100 * options->error_target);
    if (job->request->default_outputs && !job->share)
        ec_say(&job->listener->log, "note: no -o given: the picture goes to %s and %s in the current directory",
                       job->request->outputs.file[0].path, job->request->outputs.file[1].path);
    if (job->request->has_slice)
        snprintf(range, sizeof range, "samples %u to %u of ", job->request->slice_first, job->request->slice_end);
    const unsigned long long there = samples_there(job);
    if (is_complete(job)) {
        ec_say(&job->listener->log, "'%s' already has %llu samples a pixel, and %u are asked for; the picture is written "
                       "as it is", job->request->resume, there, samples_asked(job->request));
        return;
    }
    if (job->request->resume)
        ec_say(&job->listener->log, "continuing from '%s' at %llu samples a pixel", job->request->resume, there);
    if (job->share && job->frame.name)
        snprintf(range, sizeof range, "%.*s (%u of %u): ", EC_CUT(job->frame.name, 80), job->frame.place, job->frame.count);
    else if (job->share)
        snprintf(range, sizeof range, "frame %u (%u of %u), at %s: ", job->frame.number, job->frame.place, job->frame.count, when);
    describe_helpers(job, more, sizeof more);
    ec_say(&job->listener->log, "rendering %s%ux%u pixels on %s%s until %s", range, options->width, options->height,
                   job->devices[0].name, more, limits);
}

/* Warns of devices that do not round division and square root correctly: bits are the same on all others. */
static void warn_of_rounding(const ec_render_job *job, const ec_log *log)
{
    for (uint32_t i = 0; i < job->device_count; i++) {
        const ec_device_info *one = &job->devices[i];
        bool is_alike = true;
        for (uint32_t k = 0; k < job->device_count; k++)
            is_alike &= !strcmp(one->name, job->devices[k].name) && !strcmp(one->driver, job->devices[k].driver);
        if (is_alike || ec_device_rounds(one)) continue;
        ec_warn(log, "%s does not say that it rounds division and square root correctly; if it does not, the last bits differ from those of one "
                     "device", one->name);
    }
}

/* Opens the devices. Those that fail are left out, if there are others. */
static ec_result open_devices(ec_render_job *job, ec_cl *devices, const ec_log *log, ec_error *err)
{
    uint32_t count = 0, wanted = job->device_count;
    for (uint32_t i = 0; i < wanted; i++) {
        ec_error why = {0};
        if (ec_cl_open_beside(&job->devices[i], devices, count, &devices[count], &why) == EC_OK) {
            job->devices[count] = job->devices[i];
            job->device_indices[count++] = job->device_indices[i];
        } else if (count || i + 1 < wanted) {
            ec_warn(log, "%s has failed, and the others take over its work: %s", job->devices[i].name, why.text);
        } else if (err) {
            *err = why;
        }
    }
    job->device_count = count;
    if (count) warn_of_rounding(job, log);
    return count ? EC_OK : EC_FAILED;
}

/* Opens the devices once for all pictures, and again after a picture that failed; those that do not open are left out for the rest. */
static ec_result open_shared(ec_render_job *job, const ec_log *log, ec_error *err)
{
    ec_frame_share *share = job->share;
    if (share->animation) job->request->options.followed = &share->followed;
    if (share->is_open) return EC_OK;
    EC_TRY(open_devices(job, share->cl, log, err));
    memcpy(share->devices, job->devices, sizeof share->devices);
    memcpy(share->device_indices, job->device_indices, sizeof share->device_indices);
    share->device_count = job->device_count;
    for (uint32_t i = 0; i < share->device_count; i++) share->cl[i].keeps_programs = share->cl[i].keeps_buffers = true;
    share->is_open = true;
    return EC_OK;
}

/* Adds the shadow; a failure is only a warning, as the picture is worth more. */
static void cast_shadow(ec_render_job *job, ec_cl *cl)
{
    const ec_listener *listener = job->listener;
    ec_error why = {0};
    uint64_t spp = job->stats.samples_per_pixel;
    job->shadow_error = NAN;
    if (job->request->ground != EC_GROUND_SHADOW || !job->film.batch_count) return;
    if (spp < LEAST_OF_SHADOW) spp = LEAST_OF_SHADOW;
    if (ec_shadow_cast(cl, job->scene, &job->request->options, (uint32_t)spp, listener->progress, listener->user, &job->film, &job->shadow_error, &listener->log,
                       &why) != EC_OK)
        ec_warn(&listener->log, "the alpha has no shadow: %s", why.text);
}

ec_result ec_render_job_run(ec_render_job *job, ec_error *err)
{
    const ec_listener *listener = job->listener;
    const ec_log *log = &listener->log;
    const ec_course course = ec_render_job_course(job);
    ec_cl own[EC_DEVICES_MOST], *devices = job->share ? job->share->cl : job->early.context ? &job->early : own;
    if (job->share) EC_TRY(open_shared(job, log, err));
    else if (devices == own) EC_TRY(open_devices(job, devices, log, err));
    listener->begin(listener->user, &job->request->options, true); /* before this there is nothing to save */
    if (job->ranks) ec_ranks_note_binding(job->ranks, job->devices, job->device_count, log);
    else if (!job->share && !job->request->has_slice && ec_ranks_apart() > 1)
        ec_warn(log, "srun started %d processes that do not know of one another, so each renders the whole picture; with 'srun --mpi=pmix', or "
                      "a type that 'srun --mpi=list' shows, they render it together", ec_ranks_apart());
    announce(job);
    char *going_on = say_how_to_go_on(job);
    if (job->ranks) hint_at_resume(job, going_on);
    free(going_on);
    ec_result result = ec_render_course(devices, job->device_count, job->scene, &job->request->options, &course,
                                        listener->progress, listener->user, &job->film, &job->stats, log, err);
    cast_shadow(job, devices);
    listener->end(listener->user);
    for (uint32_t i = 0; !job->share && i < job->device_count; i++) ec_cl_close(&devices[i]);
    if (job->share && job->share->animation) ec_followed_tell(&job->share->followed, job->stats.trace_seconds);
    const bool has_picture = job->film.batch_count || job->rows;
    if (result == EC_OK && !has_picture) result = ec_fail(err, "no batch of samples was finished");
    if (result != EC_OK && !has_picture && listener->should_stop(listener->user) && job->has_kept)
        return ec_fail(err, "interrupted before there was a picture; 'eclat render --resume %s' continues", job->request->checkpoint);
    if (result != EC_OK && !has_picture && listener->should_stop(listener->user))
        return ec_fail(err, "interrupted before there was a picture; nothing is written");
    if (result == EC_OK && job->film.unsampled && job->request->checkpoint && !job->has_kept && !*job->keep_error.text)
        ec_warn(log, "no checkpoint is written, since no wave of samples was complete");
    return result;
}
