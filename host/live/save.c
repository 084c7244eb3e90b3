/* Saves pictures to files, as `eclat render` would have written them. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "live/renderer.h"
#include "report/scene_report.h"

/* Numbers the files, NAME.exr, NAME-2.exr …, so that a later picture does not replace an earlier one of this session. */
static void number_outputs(ec_outputs *outputs, int number)
{
    for (int i = 0; i < outputs->count && number > 1; i++) {
        char *path = outputs->file[i].path, *dot = strrchr(path, '.'), numbered[PATH_MAX];
        if (snprintf(numbered, sizeof numbered, "%.*s-%d%s", (int)(dot - path), path, number, dot) < (int)sizeof numbered)
            memcpy(path, numbered, sizeof numbered);
    }
}

/* Returns the options of the command that renders the picture again. */
static ec_render_options options_of(const ec_renderer *r, const eclat_view_request *view)
{
    const ec_live_setup *s = r->setup[ECLAT_PICTURE];
    ec_render_options options = s->options;
    options.width = view->width;
    options.height = view->height;
    options.spp = (uint32_t)ec_film_samples_of_all(&r->picture.film);
    options.more_effects = r->live->request.options.more_effects;
    options.error_target = options.time_limit = 0;
    options.denoise = r->picture.limits.denoise;
    if (!view->is_moved) options.camera = ec_live_camera(s->scene, view);
    return options;
}

static ec_render_stats stats_of(const ec_renderer *r, const ec_render_options *options)
{
    const ec_live_film *p = &r->picture;
    ec_render_stats stats = r->setup[ECLAT_PICTURE]->stats;
    stats.replicates = p->film.replicates;
    stats.seconds = p->seconds;
    stats.samples_per_pixel = options->spp;
    stats.samples = (uint64_t)options->spp * options->width * options->height;
    stats.samples_per_second = p->seconds > 0 ? (double)stats.samples / p->seconds : 0;
    stats.film = p->error;
    stats.sums = (ec_error_sums){0};
    stats.invalid_samples = p->invalid;
    snprintf(stats.stopped_by, sizeof stats.stopped_by, "%s", p->stopped_by ? p->stopped_by : "user");
    return stats;
}

/* Writes files as if the loaded job had rendered the film. */
static ec_result write_files(const ec_renderer *r, const eclat_view_request *view, ec_render_request *request, const char *command, ec_error *err)
{
    const ec_live_scene *scene = r->setup[ECLAT_PICTURE]->scene;
    ec_render_job job = scene->job;
    const uint32_t index = request->options.camera;
    const ec_camera *camera = &job.scene->cameras[index];
    const char *names[EC_OUTPUTS_MAX];
    job.request = request;
    job.command = command;
    job.film = r->picture.film;
    job.denoised = r->picture.denoised;
    job.stats = stats_of(r, &request->options);
    if (view->is_moved) job.viewpoint = ec_live_viewpoint(view);
    else if (index != scene->request.options.camera)
        ec_camera_viewpoint(camera, job.scene->center, ec_camera_reach(job.scene, camera), &job.viewpoint);
    if (view->is_moved) snprintf(job.camera_text, sizeof job.camera_text, "of the preview window");
    else ec_camera_describe(job.scene, index, job.camera_text, sizeof job.camera_text);
    const size_t used = strlen(job.environment_text);
    if (view->env_degrees != 0)
        snprintf(job.environment_text + used, sizeof job.environment_text - used, ", turned by %g degrees", view->env_degrees);
    ec_render_report report = ec_render_job_report(&job, names);
    return ec_render_job_write(&job, &request->outputs, &report, err);
}

static void tell_files(const ec_outputs *outputs, const char *command, char *told, size_t size)
{
    int used = snprintf(told, size, "saved");
    for (int i = 0; i < outputs->count && used > 0 && (size_t)used < size; i++)
        used += snprintf(told + used, size - (size_t)used, "%s %s", i ? "," : "", outputs->file[i].path);
    if (used > 0 && (size_t)used < size) snprintf(told + used, size - (size_t)used, "; again by: %s", command);
}

static ec_result save(ec_renderer *r, const eclat_view_request *view, char *told, size_t size, ec_error *err)
{
    const ec_live *live = r->live;
    ec_render_request request = live->request;
    request.options = options_of(r, view);
    request.exposure = (ec_exposure){.stops = view->exposure};
    request.tonemap = (ec_tonemap)view->tonemap;
    if (request.outputs.count == 0) EC_TRY(ec_outputs_add_default(&request.outputs, request.scene, err));
    number_outputs(&request.outputs, r->saved + 1);
    EC_TRY(ec_render_check_files(&request, err));
    char *command = ec_live_command(live, r->setup[ECLAT_PICTURE]->scene, view, &request.options, &request.outputs);
    if (!command) return ec_fail(err, "out of memory for a command line");
    if (request.options.denoise) ec_live_film_clean(&r->picture, &r->live->device, true);
    ec_result result = write_files(r, view, &request, command, err);
    if (result == EC_OK) {
        r->saved++;
        tell_files(&request.outputs, command, told, size);
        if (live->hears.saved) live->hears.saved(live->hears.user, command);
    }
    free(command);
    return result;
}

static void finish(ec_renderer *r, const ec_live_asked *asked, bool is_unsaved, const char *told)
{
    eclat_status *s = &r->live->status;
    pthread_mutex_lock(&r->live->lock);
    snprintf(s->told, sizeof s->told, "%s", told);
    s->is_unsaved = is_unsaved;
    s->saves = r->saves = asked->saves;
    ec_live_tell(r->live);
    pthread_mutex_unlock(&r->live->lock);
}

void ec_renderer_serve_save(ec_renderer *r, const ec_live_asked *asked)
{
    if (asked->saves == r->saves) return;
    char told[2048] = "";
    ec_error err = {0};
    if (r->picture.film.batch_count && ec_live_same_camera(&asked->saved, &r->view)) {
        bool is_unsaved = save(r, &asked->saved, told, sizeof told, &err) != EC_OK;
        finish(r, asked, is_unsaved, is_unsaved ? err.text : told);
    } else if (!ec_live_same_camera(&asked->saved, &asked->view)) {
        finish(r, asked, true, "not saved: the camera moved before the first samples were complete; keep it still and save again");
    }
}
