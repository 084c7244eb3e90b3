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
        uint64_t bytes_per_path = 4 * (2 * EC_PATH_FIELDS + EC_HIT_FIELDS + EC_SHADOW_FIELDS + 3 + EC_AOV_FIELDS);
        while (wave > 4096 && (wave * bytes_per_path > cl->info.memory_bytes / 4 ||
                               wave * 4 * EC_PATH_FIELDS > cl->info.max_allocation_bytes))
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

static void choose_traces(ec_pipeline *p, const ec_scene *scene, const char *trace)
{
    bool is_auto = !trace || !strcmp(trace, "auto");
    bool is_cpu = p->cl->info.type & CL_DEVICE_TYPE_CPU;
    /* A GPU gets the scalar kernel. On a CPU packets cannot win any more where a scene has many small triangles. */
    p->has_trace[EC_TRACE_PACKET] = is_auto ? !is_cpu || scene->triangle_count <= (1u << 20) : !strcmp(trace, "packet");
    p->has_trace[EC_TRACE_BVH8] = is_auto ? is_cpu && scene->triangle_count > 64 : !strcmp(trace, "bvh8");
}

ec_result ec_pipeline_create(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, uint32_t batch,
                             ec_pipeline *p, ec_render_stats *stats, ec_error *err)
{
    memset(p, 0, sizeof *p);
    p->cl = cl;
    p->integrator = options->integrator;
    p->lanes = options->lanes ? options->lanes : cl->info.native_float_width;
    if (p->lanes != 1 && p->lanes != 4 && p->lanes != 8 && p->lanes != 16)
        p->lanes = p->lanes > 16 ? 16 : (p->lanes > 8 ? 8 : (p->lanes > 4 ? 4 : 1));
    if (!options->lanes && cl->info.type & CL_DEVICE_TYPE_GPU) p->lanes = 1;
    choose_traces(p, scene, options->trace);

    double start = ec_now();
    ec_result result = ec_pipeline_upload_accel(p, scene, err);
    stats->accel_seconds = ec_now() - start;
    if (result != EC_OK) return result;

    start = ec_now();
    ec_pack pack;
    EC_TRY(ec_pack_scene(scene, &pack, err));
    p->features = options->all_effects ? (uint32_t)EC_FEATURE_ALL & ~(uint32_t)EC_FEATURE_SOBOL : pack.features;
    if (options->sampler == EC_SAMPLER_SOBOL) p->features |= EC_FEATURE_SOBOL;
    p->wave = fit_wave(cl, options, batch, p->lanes);
    ec_params *params = &p->params;
    set_camera(scene, options, params);
    params->width = options->width;
    params->height = options->height;
    params->batch = batch;
    params->wave = p->wave;
    params->part = p->wave / EC_PARTS;
    params->max_depth = options->max_depth ? options->max_depth : UINT32_MAX - EC_SEGMENT;
    set_roulette(options->survival, params);
    params->sample = options->sample;
    bool joins = options->sample == EC_SAMPLE_MIS || options->sample == EC_SAMPLE_LIGHT || scene->light_count;
    params->light_count = joins ? pack.light_count : 0;
    params->environment_width = pack.environment_width;
    params->environment_height = pack.environment_height;
    params->environment_pmf = pack.environment_pmf;
    for (int k = 0; k < 3; k++)
        params->environment[k] = !scene->has_environment ? 0.0f : scene->environment.rgb ? 1.0f : scene->environment.constant[k];
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

ec_result ec_pipeline_run_wave(ec_pipeline *p, uint32_t seed, uint32_t first_pixel, uint32_t pixel_count,
                               bool with_features, ec_error *err)
{
    static ec_run_wave *const run[EC_INTEGRATOR_COUNT] = {[EC_INTEGRATOR_PATH] = ec_run_path_wave};
    return run[p->integrator](p, seed, first_pixel, pixel_count, with_features, err);
}

void ec_pipeline_destroy(ec_pipeline *p)
{
    if (!p->cl) return;
    for (int i = 0; i < EC_STAGE_ID_COUNT; i++)
        if (p->kernels[i]) clReleaseKernel(p->kernels[i]);
    for (int i = 0; i <= EC_LANES_MOST; i++)
        if (p->programs[i]) clReleaseProgram(p->programs[i]);
    p->buffers[EC_ARG_PATHS] = p->buffers[EC_ARG_NEXT] = NULL; /* views of path_queues */
    for (int i = 0; i < EC_ARG_COUNT; i++) ec_buffer_release(p->cl, &p->buffers[i]);
    for (int i = 0; i < 2; i++) ec_buffer_release(p->cl, &p->path_queues[i]);
    memset(p, 0, sizeof *p);
}
