/* Set-up and tear-down of a render on one device. */
#include "pipeline/pipeline.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"

static void set_camera(const ec_scene *scene, const ec_render_options *o, ec_params *params)
{
    const ec_camera *c = &scene->cameras[o->camera];
    double aspect = (double)o->width / o->height;
    bool is_flat = c->type == EC_CAMERA_ORTHOGRAPHIC;
    double half_height = is_flat ? c->ymag : tan(0.5 * c->yfov);
    double half_width = is_flat && c->aspect <= 0.0f && c->xmag > 0.0f ? c->xmag : half_height * aspect;
    for (int k = 0; k < 3; k++) {
        params->camera_origin[k] = c->position[k];
        params->camera_right[k] = (float)(c->right[k] * half_width);
        params->camera_up[k] = (float)(c->up[k] * half_height);
        params->camera_forward[k] = c->forward[k];
    }
    params->orthographic = is_flat;
}

/* Paths in flight: enough to fill a GPU; on a CPU enough for a launch to last longer than waking its threads. (Queues that
 * stay in the cache gain 5 % of processor time there; launches of a tenth the size lose 40 % of wall time.) */
static uint32_t fit_wave(const ec_cl *cl, const ec_render_options *o, uint32_t batch, uint32_t lanes)
{
    uint64_t wave = o->wave;
    if (!wave) {
        wave = cl->info.type & CL_DEVICE_TYPE_CPU ? (uint64_t)1 << 18 : (uint64_t)1 << 20;
        uint64_t stack = o->integrator == EC_INTEGRATOR_WHITTED ? ec_whitted_stack_words(o->max_depth) : 0;
        uint64_t words = 2 * EC_PATH_FIELDS + EC_HIT_FIELDS + EC_SHADOW_FIELDS + 3 + EC_AOV_FIELDS + stack;
        uint64_t widest = stack > EC_PATH_FIELDS ? stack : EC_PATH_FIELDS;
        while (wave > 4096 && (wave * 4 * words > cl->info.memory_bytes / 4 || wave * 4 * widest > cl->info.max_allocation_bytes))
            wave /= 2;
    }
    uint64_t samples = (uint64_t)o->width * o->height * batch;
    if (wave > samples) wave = samples;
    if (wave < batch) wave = batch;
    uint64_t unit = (uint64_t)EC_PARTS * lanes; /* every part of a queue holds whole packets */
    return (uint32_t)((wave + unit - 1) / unit * unit);
}

/* A constant probability is used from the first surface on, as a first path tracer does it; the one that goes by throughput
 * starts late, since it tells least from bright short paths. Rounded down to a multiple of 2^-24, the step of the random
 * numbers, so that what is divided by is what is sampled, and nothing under 1 becomes 1, which would never end. */
static void set_roulette(double survival, ec_params *params)
{
    params->first_roulette = survival == 0.0 ? 5 : survival < 1.0 ? 1 : UINT32_MAX;
    params->survival = survival == 0.0 ? 0.0f : (float)ldexp(fmax(floor(ldexp(survival, 24)), 1.0), -24);
}

static ec_result choose_accels(ec_pipeline *p, const ec_scene *scene, const char *name, ec_error *err)
{
    uint32_t chosen;
    EC_TRY(ec_accels_choose(name, scene->triangle_count, p->cl->info.type & CL_DEVICE_TYPE_CPU, &chosen, err));
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) p->accels[a].in_use = chosen >> a & 1;
    return EC_OK;
}

uint32_t ec_pipeline_lanes(const ec_cl *cl, uint32_t wanted)
{
    uint32_t lanes = wanted ? wanted : cl->info.native_float_width;
    if (!wanted && cl->info.type & CL_DEVICE_TYPE_GPU) return 1;
    return lanes >= 16 ? 16 : lanes >= 8 ? 8 : lanes >= 4 ? 4 : 1;
}

ec_result ec_pipeline_create(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, uint32_t batch,
                             ec_pipeline *p, ec_render_stats *stats, ec_error *err)
{
    memset(p, 0, sizeof *p);
    p->cl = cl;
    p->triangle_count = scene->triangle_count;
    p->integrator = options->integrator;
    p->fast_math = options->fast_math;
    p->lanes = ec_pipeline_lanes(cl, options->lanes);
    if (p->integrator != EC_INTEGRATOR_RASTER) EC_TRY(choose_accels(p, scene, options->accel, err));

    double start = ec_now();
    ec_result result = ec_pipeline_upload_accels(p, scene, options->grid_density, err);
    stats->accel_seconds = ec_now() - start;
    if (result != EC_OK) return result;

    start = ec_now();
    ec_pack pack;
    EC_TRY(ec_pack_scene(scene, &pack, err));
    if (p->integrator != EC_INTEGRATOR_PATH && (result = ec_pack_light_centres(scene, &pack, err)) != EC_OK) {
        ec_pack_free(&pack);
        return result;
    }
    p->features = options->all_effects ? EC_FEATURE_ALL & ~EC_FEATURE_SOBOL : pack.features;
    if (options->sampler == EC_SAMPLER_SOBOL) p->features |= EC_FEATURE_SOBOL;
    p->wave = fit_wave(cl, options, batch, p->lanes);
    ec_params *params = &p->params;
    set_camera(scene, options, params);
    params->width = options->width;
    params->height = options->height;
    params->batch = batch;
    params->wave = p->wave;
    params->part = p->wave / EC_PARTS;
    const uint32_t unlimited = p->integrator == EC_INTEGRATOR_WHITTED ? EC_WHITTED_DEPTH : UINT32_MAX - EC_SEGMENT;
    params->max_depth = options->max_depth ? options->max_depth : unlimited;
    params->cutoff = (float)options->cutoff;
    set_roulette(options->survival, params);
    params->sample = options->sample;
    bool joins = options->sample == EC_SAMPLE_MIS || options->sample == EC_SAMPLE_LIGHT || scene->light_count;
    params->light_count = joins ? pack.light_count : 0;
    params->environment_width = pack.environment_width;
    params->environment_height = pack.environment_height;
    params->environment_pmf = pack.environment_pmf;
    for (int k = 0; k < 3; k++)
        params->environment[k] = !scene->has_environment ? 0.0f : scene->environment.rgb ? 1.0f : scene->environment.constant[k];
    memcpy(params->environment_mean, pack.environment_mean, sizeof pack.environment_mean);
    params->scene_radius = pack.scene_radius;
    params->scene_max = pack.scene_max;
    result = ec_pipeline_upload(p, scene, &pack, err);
    ec_pack_free(&pack);
    if (result == EC_OK) result = ec_pipeline_create_queues(p, err);
    stats->pack_seconds = ec_now() - start;
    if (result != EC_OK) return result;

    start = ec_now();
    result = ec_pipeline_build(p, err);
    stats->kernel_seconds = ec_now() - start;
    stats->lanes = p->lanes;
    stats->wave = p->wave;
    stats->batch = batch;
    ec_feature_names(p->features, stats->effects, sizeof stats->effects);
    return result;
}

ec_result ec_pipeline_read_invalid(ec_pipeline *p, uint32_t counts[EC_STAGE_COUNT], ec_error *err)
{
    return ec_buffer_read(p->cl, p->buffers[EC_ARG_INVALID], 0, EC_STAGE_COUNT * sizeof *counts, counts, err);
}

void ec_pipeline_destroy(ec_pipeline *p)
{
    if (!p->cl) return;
    for (int i = 0; i < EC_STAGE_ID_COUNT; i++)
        if (p->kernels[i]) clReleaseKernel(p->kernels[i]);
    for (int a = 0; a < EC_ACCEL_COUNT; a++) {
        for (int i = 0; i < 2; i++)
            if (p->accels[a].kernels[i]) clReleaseKernel(p->accels[a].kernels[i]);
        for (int k = 0; k < EC_ACCEL_BUFFERS; k++) ec_buffer_release(p->cl, &p->accels[a].buffers[k]);
    }
    for (int i = 0; i <= EC_LANES_MOST; i++)
        if (p->programs[i]) clReleaseProgram(p->programs[i]);
    p->buffers[EC_ARG_PATHS] = p->buffers[EC_ARG_NEXT] = NULL; /* views of path_queues, as these of accels */
    memset(&p->buffers[EC_ARG_ACCEL], 0, EC_ACCEL_BUFFERS * sizeof *p->buffers);
    for (int i = 0; i < EC_ARG_COUNT; i++) ec_buffer_release(p->cl, &p->buffers[i]);
    for (int i = 0; i < 2; i++) ec_buffer_release(p->cl, &p->path_queues[i]);
    memset(p, 0, sizeof *p);
}
