#include "jobs/render_job.h"

#include <omp.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "cl/drivers.h"
#include "cl/workarounds.h"
#include "jobs/backdrop.h"
#include "jobs/blank.h"
#include "jobs/denoise_choice.h"
#include "jobs/job_camera.h"
#include "jobs/option.h"
#include "jobs/shadow.h"
#include "render/strips.h"
#include "gltf/reader.h"
#include "scene/built_in.h"
#include "scene/ground.h"

/* Demands an EXR for a slice, which consists of its sums; a PNG alone would discard them. */
static ec_result check_slice_output(const ec_render_request *request, ec_error *err)
{
    return !request->has_slice || ec_outputs_have_exr(&request->outputs) ? EC_OK : ec_usage(err, "--samples: a slice is an .exr, which eclat merge adds to others; give -o NAME.exr");
}

/* Checks a file written on the way, which this option names. */
static ec_result check_kept(const ec_render_request *request, const char *option, const char *path, ec_inputs *inputs, ec_error *err)
{
    if (!path) return EC_OK;
    if (ec_inputs_have(inputs, path))
        return ec_fail(err, "'%s' is an input of this job; give --%s another name", path, option);
    for (int i = 0; i < request->outputs.count; i++)
        if (ec_same_target(path, request->outputs.file[i].path))
            return ec_usage(err, "'%s' is both the %s and the picture; give one of them another name", path, option);
    return ec_image_check_writable(path, err);
}

/* Checks the files. The checkpoint that is resumed may be the next checkpoint too, but not a picture. */
ec_result ec_render_check_files(const ec_render_request *request, ec_error *err)
{
    const char *const files[] = {request->environment, request->resume};
    ec_inputs inputs = {.scene = request->scene, .files = files, .file_count = 1};
    ec_result result = check_kept(request, "checkpoint", request->checkpoint, &inputs, err);
    inputs.file_count = 2;
    if (result == EC_OK) result = check_kept(request, "snapshot", request->snapshot, &inputs, err);
    if (result == EC_OK && request->snapshot && request->checkpoint && ec_same_target(request->snapshot, request->checkpoint))
        result = ec_usage(err, "'%s' is both the snapshot and the checkpoint; give one of them another name", request->snapshot);
    if (result == EC_OK) result = ec_outputs_check(&request->outputs, &inputs, err);
    ec_inputs_free(&inputs);
    return result;
}

static ec_result prepare_outputs(ec_render_request *request, ec_error *err)
{
    ec_outputs *outputs = &request->outputs;
    request->default_outputs = outputs->count == 0;
    if (request->default_outputs && request->has_slice)
        EC_TRY(ec_outputs_add_named(outputs, request->scene, err, ".%u-%u.exr", request->slice_first, request->slice_end));
    else if (request->default_outputs)
        EC_TRY(ec_outputs_add_default(outputs, request->scene, err));
    EC_TRY(check_slice_output(request, err));
    return ec_render_check_files(request, err);
}

static void name_environment(const ec_render_request *r, char key[400])
{
    snprintf(key, 400, "%.17g %.17g %s", r->env_degrees, r->env_strength, r->environment ? r->environment : "");
}

static bool is_environment_there(const ec_render_job *job)
{
    char key[400];
    if (!job->share || !job->share->environment_known) return false;
    name_environment(job->request, key);
    return job->share->animation || (job->request->environment && !strcmp(key, job->share->environment_key));
}

/* Shares an environment map, which is read, scaled and turned once for all pictures. A sky made only because one picture has no light is not shared. */
static ec_result share_environment(ec_render_job *job, bool is_of_all, ec_error *err)
{
    ec_frame_share *share = job->share;
    if (!share || !is_of_all || is_environment_there(job)) return EC_OK;
    ec_frame_share_drop_environment(share);
    name_environment(job->request, share->environment_key);
    if (job->scene->environment.rgb) EC_TRY(ec_pack_map(&job->scene->environment, &share->packed, err));
    share->environment = job->scene->environment;
    share->has_environment = job->scene->has_environment;
    share->environment_known = true;
    if (share->environment.rgb) share->environment.packed = &share->packed;
    job->scene->environment = share->environment;
    job->scene->environment.lent = true;
    return EC_OK;
}

ec_result ec_render_job_light(ec_render_job *job, ec_error *err)
{
    const ec_log *log = &job->listener->log;
    const char *environment = job->request->environment;
    const bool is_there = is_environment_there(job), is_of_all = environment || (job->share && job->share->animation && job->scene->has_environment);
    if (is_there) {
        job->scene->environment = job->share->environment;
        job->scene->environment.lent = true;
        job->scene->has_environment = job->share->has_environment;
    } else if (environment) {
        if (job->scene->has_environment) ec_note(log, "--light replaces the scene's image-based light");
        EC_TRY(ec_scene_set_environment(job->scene, environment, log, err));
    } else if (!job->request->adjusts_env) {
        ec_scene_light light;
        EC_TRY(ec_scene_find_light(job->scene, &light, err));
        if (!light.any) {
            ec_note(log, "the scene has no light; the built-in studio lights it (--light chooses another)");
            environment = EC_STUDIO;
            EC_TRY(ec_scene_set_environment(job->scene, environment, log, err));
        }
    }
    if (job->request->adjusts_env && !is_there) {
        if (!environment && !job->scene->has_environment)
            return ec_fail(err, "--env-rotate and --env-strength: the scene has no environment; give one with --light, or leave them out");
        ec_scene_adjust_environment(job->scene, job->request->env_degrees, job->request->env_strength, log);
    }
    EC_TRY(share_environment(job, is_of_all, err));
    if (!environment) environment = job->scene->has_environment ? "the scene's" : "none";
    int used = snprintf(job->environment_text, sizeof job->environment_text, "%s", environment);
    if (job->request->adjusts_env && used > 0 && (size_t)used < sizeof job->environment_text)
        snprintf(job->environment_text + used, sizeof job->environment_text - (size_t)used, ", turned by %g degrees, strength %g",
                 job->request->env_degrees, job->request->env_strength);
    return EC_OK;
}

/* Fails if the picture cannot fit into memory, as memory is promised before it exists, and the process would be killed. Checked here early, and again
 * when the scene is on the device. */
static ec_result check_memory(const ec_render_job *job, ec_error *err)
{
    const ec_render_options *options = &job->request->options;
    const uint32_t peers = job->ranks ? (uint32_t)ec_ranks_count(job->ranks) - 1 : 0;
    const char *reason = ec_render_whole_for(job->request), *instead = "leave it out";
    if (job->in_memory) reason = "a render without output files", instead = "name one by the option output";
    if (peers) reason = "an MPI job", instead = "start one process without mpirun";
    if (job->device_count > 1) reason = "more than one --device", instead = "name one";
    uint64_t needed = ec_strip_whole_for(options, job->devices, job->device_count, peers);
    uint64_t present = ec_memory_of_machine();
    int64_t budget = options->memory ? ec_strip_budget(options, 0) : (int64_t)present;
    if (reason && (int64_t)needed > budget) return ec_strip_refuse(options, needed, budget, reason, instead, err);
    return EC_OK;
}

ec_result ec_render_job_prepare(ec_render_job *job, ec_error *err)
{
    const ec_render_options *options = &job->request->options;
    EC_TRY(prepare_outputs(job->request, err));
    EC_TRY(ec_render_job_load(job, err));
    ec_outputs_check_room(&job->request->outputs, (uint64_t)options->width * options->height, ec_render_channels(job->request),
                          &job->listener->log);
    return EC_OK;
}

/* If a processor was chosen, warns of an installed driver that the OpenCL loader does not know: the render may take a hundred times as long as it
 * need. */
static void warn_of_unnamed(const ec_render_job *job)
{
    char text[256];
    if (!strcmp(job->device_why, "first CPU") && ec_drivers_unnamed(text, sizeof text)) ec_warn(&job->listener->log, "%s", text);
}

ec_result ec_render_job_find_devices(ec_render_job *job, ec_error *err)
{
    const char *wanted = job->request->device;
    EC_TRY(ec_device_find_several(wanted, job->devices, job->device_indices, job->takes_several ? EC_DEVICES_MOST : 1, &job->device_count,
                                  &job->device_why, err));
    if (job->request->plan_ranks && job->device_count > 1)
        return ec_fail(err, "--plan takes one device, which stands for those of all machines; name one with --device");
    warn_of_unnamed(job);
    if (job->ranks) ec_ranks_share_devices(job->ranks, job->devices, job->device_indices, &job->device_count);
    return EC_OK;
}

/* Takes the devices of all pictures. */
static void take_devices(ec_render_job *job)
{
    const ec_frame_share *share = job->share;
    memcpy(job->devices, share->devices, sizeof job->devices);
    memcpy(job->device_indices, share->device_indices, sizeof job->device_indices);
    job->device_count = share->device_count;
    job->device_why = share->device_why;
}

static ec_result load_scene(ec_render_job *job, ec_error *err)
{
    const ec_log *log = &job->listener->log;
    const ec_render_request *request = job->request;
    if (job->share && job->share->animation) EC_TRY(ec_animation_show(job->share->animation, &request->choice, &job->scene, log, err));
    else EC_TRY(ec_scene_load_choice(request->scene, &request->choice, &job->scene, log, err));
    if (request->ground == EC_GROUND_MATTE) EC_TRY(ec_scene_add_ground(job->scene, err));
    EC_TRY(ec_render_job_light(job, err));
    return request->ground == EC_GROUND_SHADOW ? ec_shadow_check(job->scene, err) : EC_OK;
}

/* Finds the device and opens it, if its driver lets kernels be built while the scene is loaded. Others gain nothing by that, and contexts of Oclgrind
 * work only in the thread that makes them. */
static ec_result find_and_open(ec_render_job *job, ec_error *err)
{
    EC_TRY(ec_render_job_find_devices(job, err));
    if (!job->renders || job->ranks || job->device_count != 1 || !ec_compiles_late(&job->devices[0])) return EC_OK;
    EC_TRY(ec_cl_open(&job->devices[0], &job->early, err));
    ec_last_build_begin(&job->last_build, &job->early, job->request->scene, job->request->options.integrator);
    return EC_OK;
}

typedef struct finder {
    ec_render_job *job;
    ec_result result;
    ec_error error;
} finder;

static void *find_devices(void *user)
{
    finder *f = user;
    f->result = find_and_open(f->job, &f->error);
    return NULL;
}

/* Starts the threads that load a scene. They must exist before a driver's libraries are loaded, since no thread can begin while these are linked. */
static void begin_threads(void)
{
#pragma omp parallel
    (void)omp_get_thread_num();
}

/* Loads drivers and scene at once, as drivers take as long to load as many a scene. An unknown device name is reported before a scene is loaded. */
static ec_result load_both(ec_render_job *job, ec_error *err)
{
    finder f = {.job = job};
    pthread_t thread;
    begin_threads();
    const bool is_beside = !job->ranks && !job->request->device && pthread_create(&thread, NULL, find_devices, &f) == 0;
    if (!is_beside) EC_TRY(find_and_open(job, err));
    const ec_result result = load_scene(job, err);
    if (is_beside) pthread_join(thread, NULL);
    if (is_beside && f.result != EC_OK && err) *err = f.error;
    return f.result != EC_OK ? EC_FAILED : result;
}

static ec_result find_layers(ec_render_job *job, ec_error *err)
{
    ec_render_request *request = job->request;
    ec_render_options *o = &request->options;
    if (request->light_groups) EC_TRY(ec_light_groups_find(job->scene, request->light_groups, &job->groups, err));
    o->groups = &job->groups;
    o->layers.group_count = job->groups.count;
    o->layers.count = (uint32_t)__builtin_popcount(o->layers.kinds) + job->groups.count;
    memcpy(o->layers.groups, job->groups.names, sizeof o->layers.groups);
    EC_TRY(ec_matte_names_find(job->scene, o->layers.mattes, &job->mattes, err));
    for (uint32_t k = 0; k < EC_MATTE_KINDS; k++) o->layers.matte_hashes[k] = job->mattes.hashes[k];
    if ((o->layers.count || o->layers.mattes) && job->ranks)
        return ec_usage(err, "--channels direct, indirect, position, uv, motion or cryptomatte, and --light-groups, do not work with several processes; leave them out, or run without mpirun");
    return EC_OK;
}

ec_result ec_render_job_load(ec_render_job *job, ec_error *err)
{
    const double start = ec_now();
    ec_denoiser found;
    if (job->request->ocio.config) EC_TRY(ec_ocio_open(&job->request->ocio, &job->ocio, err));
    EC_TRY(ec_require_denoiser(job->request->options.denoise, &found, &job->listener->log, err));
    if (job->share) {
        take_devices(job);
        EC_TRY(load_scene(job, err));
    } else {
        EC_TRY(load_both(job, err));
    }
    job->load_seconds = ec_now() - start;
    EC_TRY(find_layers(job, err));
    EC_TRY(ec_job_camera(job, err));
    if (job->request->background.kind == EC_BACKDROP_BLUR)
        EC_TRY(ec_backdrop_make(job->scene, &job->request->options, (double)job->request->background.degrees, &job->behind, err));
    job->is_blank = ec_warn_of_blank(job);
    return check_memory(job, err);
}

/* Copies the options, with light paths and guiding as the render has them: chosen, or left out where they do not apply. */
static void find_rendered(const ec_render_job *job, ec_render_options *o)
{
    *o = job->request->options;
    if (o->light_paths == EC_LIGHT_PATHS_AUTO) o->guiding = job->stats.is_guided;
    o->light_paths = job->stats.light_paths;
}

ec_render_report ec_render_job_report(ec_render_job *job, const char *outputs[EC_OUTPUTS_MAX])
{
    const ec_render_request *request = job->request;
    find_rendered(job, &job->rendered);
    for (int i = 0; i < request->outputs.count; i++) outputs[i] = request->outputs.file[i].path;
    return (ec_render_report){
        .frame = job->share ? &job->frame : NULL,
        .command = job->command,
        .scene = request->scene,
        .camera = job->camera_text,
        .viewpoint = job->viewpoint,
        .environment = job->environment_text,
        .options = &job->rendered,
        .stats = &job->stats,
        .verbose = request->verbose,
        .device = job->devices,
        .device_why = job->device_why,
        .device_index = job->device_indices,
        .exposure = ec_exposure_stops(&request->exposure, &job->film),
        .is_exposure_auto = request->exposure.is_auto,
        .tonemap = request->tonemap,
        .background = request->background,
        .behind = request->background.kind == EC_BACKDROP_BLUR ? &job->behind : NULL,
        .has_shadow = request->ground == EC_GROUND_SHADOW,
        .shadow_error = job->shadow_error,
        .mattes = &job->mattes,
        .view = &request->ocio,
        .ocio = job->ocio,
        .is_png_deep = request->png_depth != 0,
        .mean_luminance = job->stats.film.mean_luminance,
        .replicates = ec_film_replicates(&job->film),
        .denoised = request->options.denoise ? &job->denoised : NULL,
        .load_seconds = job->load_seconds,
        .image_sha256 = job->image_sha256,
        .outputs = outputs,
        .output_count = request->outputs.count,
    };
}

ec_result ec_render_job_denoise(ec_render_job *job, ec_error *err)
{
    if (!job->request->options.denoise || job->stats.is_clean) return EC_OK;
    job->stats.is_clean = true; /* only one attempt, whatever its result */
    return ec_denoise(&job->film, job->request->options.denoise, &job->devices[0], &job->denoised, err);
}

void ec_render_job_free(ec_render_job *job)
{
    ec_scene_free(job->scene);
    ec_light_groups_free(&job->groups);
    ec_matte_names_free(&job->mattes);
    ec_film_destroy(&job->film);
    ec_row_writer_abort(job->rows);
    ec_stored_free(&job->stored);
    ec_given_free(&job->before);
    free(job->behind.rgb);
    ec_ocio_close(job->ocio);
    if (job->early.context) ec_cl_close(&job->early);
    free(job->whole_command);
}
