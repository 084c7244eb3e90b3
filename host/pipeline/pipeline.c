/* Set-up and tear-down of a render on one device. */
#include "pipeline/pipeline.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "cl/workarounds.h"

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
    if (scene->placed_count) name = "twolevel"; /* the others would have had them written out */
    EC_TRY(ec_accels_choose(name, scene->triangle_count, p->cl->info.type & CL_DEVICE_TYPE_CPU, &chosen, err));
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) p->accels[a].in_use = chosen >> a & 1;
    return EC_OK;
}

static ec_result choose_lights(const ec_pipeline *p, const ec_render_options *o, ec_pack *pack, ec_error *err)
{
    if (p->integrator != EC_INTEGRATOR_PATH || o->light_choice == EC_LIGHTS_BY_POWER) return EC_OK;
    if (pack->lamps_move) return EC_OK; /* a tree's bounds would hold for one moment only */
    if (o->light_choice == EC_LIGHTS_AUTO && !ec_pack_wants_light_tree(pack)) return EC_OK;
    return ec_pack_light_tree(pack, err);
}

ec_result ec_pipeline_lanes(const ec_cl *cl, uint32_t wanted, uint32_t *lanes, ec_error *err)
{
    const ec_workaround *driver = ec_workaround_for(&cl->info);
    uint32_t most = driver && driver->most_lanes ? driver->most_lanes : 16, n = wanted;
    if (wanted > most)
        return ec_fail(err, "--lanes %u on %s: %s (%s %s); leave --lanes out or choose %u", wanted, cl->info.name, driver->what,
                       driver->driver, driver->seen, most);
    if (!wanted) n = cl->info.type & CL_DEVICE_TYPE_GPU ? 1 : cl->info.native_float_width < most ? cl->info.native_float_width : most;
    *lanes = n >= 16 ? 16 : n >= 8 ? 8 : n >= 4 ? 4 : 1;
    return EC_OK;
}

/* called_for: the scene itself, or that of which it is what is written out. */
static ec_result create(ec_cl *cl, const ec_scene *scene, const ec_scene *called_for, const ec_render_options *options, uint32_t batch,
                        ec_pipeline *p, ec_render_stats *stats, ec_error *err)
{
    memset(p, 0, sizeof *p);
    p->cl = cl;
    p->triangle_count = scene->triangle_count;
    p->integrator = options->integrator;
    p->fast_math = options->fast_math;
    if (scene->motion.segments && p->integrator != EC_INTEGRATOR_PATH)
        return ec_fail(err, "only the path tracer blurs what moves: leave out --shutter, or take --integrator path");
    EC_TRY(ec_pipeline_set_camera(&scene->cameras[options->camera], options, &p->params, err));
    EC_TRY(ec_pipeline_lanes(cl, options->lanes, &p->lanes, err));
    if (p->integrator != EC_INTEGRATOR_RASTER) EC_TRY(choose_accels(p, scene, options->accel, err));

    double start = ec_now();
    ec_result result = ec_pipeline_upload_accels(p, scene, options->grid_density, err);
    stats->accel_seconds = ec_now() - start;
    if (result != EC_OK) return result;

    start = ec_now();
    ec_pack pack;
    EC_TRY(ec_pack_scene(scene, &pack, err));
    /* Rounding may not change effects. */
    if (called_for != scene && (result = ec_scene_calls(called_for, &pack.effects, err)) != EC_OK) {
        ec_pack_free(&pack);
        return result;
    }
    if (called_for != scene) pack.effects.bits &= ~EC_FEATURE_INSTANCES;
    if (p->integrator != EC_INTEGRATOR_PATH && (result = ec_pack_light_centres(&pack.plain.scene, &pack, err)) != EC_OK) {
        ec_pack_free(&pack);
        return result;
    }
    if (ec_pipeline_joins(options, &pack) && (result = choose_lights(p, options, &pack, err)) != EC_OK) {
        ec_pack_free(&pack);
        return result;
    }
    ec_pipeline_effects(options, &pack, &p->effects);
    const ec_scene *plain = &pack.plain.scene;
    ec_params *params = &p->params;
    params->width = options->width;
    params->height = options->height;
    params->batch = batch;
    const uint32_t unlimited = p->integrator == EC_INTEGRATOR_WHITTED ? EC_WHITTED_DEPTH : UINT32_MAX - EC_SEGMENT;
    params->max_depth = options->max_depth ? options->max_depth : unlimited;
    params->cutoff = (float)options->cutoff;
    params->panes_count = p->integrator == EC_INTEGRATOR_PATH;
    set_roulette(options->survival, params);
    params->sample = options->sample;
    params->light_count = ec_pipeline_joins(options, &pack) ? pack.light_count : 0;
    params->environment_width = pack.environment_width;
    params->environment_height = pack.environment_height;
    params->environment_pmf = pack.environment_pmf;
    for (int k = 0; k < 3; k++)
        params->environment[k] = !plain->has_environment ? 0.0f : plain->environment.rgb ? 1.0f : plain->environment.constant[k];
    params->environment_turned = plain->has_environment && plain->environment.turned;
    for (int k = 0; k < 9; k++) params->environment_turn[k / 3 * 4 + k % 3] = plain->environment.turn[k];
    memcpy(params->environment_mean, pack.environment_mean, sizeof pack.environment_mean);
    params->nested = pack.bodies.count > 0;
    p->bodies_too_many = pack.bodies.too_many;
    params->light_tree_pmf = pack.light_tree_pmf;
    params->scene_radius = pack.scene_radius;
    params->scene_max = pack.scene_max;
    result = ec_insides_make(&pack, &p->insides, err);
    params->camera_medium = ec_insides_of(&p->insides, &scene->cameras[options->camera]);
    if (result == EC_OK && options->identify) ec_pipeline_content(p, scene, &pack, &stats->content);
    if (result == EC_OK) result = ec_pipeline_upload(p, scene, &pack, err);
    ec_pack_free(&pack);
    if (result == EC_OK) result = ec_pipeline_upload_camera(p, scene, options, err);
    if (result == EC_OK) result = ec_pipeline_upload_filter(p, options, err);
    if (result == EC_OK) result = ec_pipeline_create_queues(p, options, err);
    stats->pack_seconds = ec_now() - start;
    if (result != EC_OK) return result;

    start = ec_now();
    result = ec_pipeline_build(p, err);
    stats->kernel_seconds = ec_now() - start;
    stats->lanes = p->lanes;
    stats->wave = p->wave;
    stats->batch = batch;
    stats->instances = scene->placed_count;
    stats->triangles = ec_scene_met_count(scene);
    stats->stored_triangles = scene->triangle_count;
    stats->effects = p->effects;
    return result;
}

/* Meshes that are kept once are written out where an accelerator or an integrator knows one level only. */
static ec_result create_in_form(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, uint32_t batch,
                             ec_pipeline *p, ec_render_stats *stats, ec_error *err)
{
    const char *accel = options->accel;
    bool keeps = options->integrator != EC_INTEGRATOR_RASTER && (!accel || !strcmp(accel, "auto") || !strcmp(accel, "twolevel"));
    if (!scene->placed_count || keeps) return create(cl, scene, scene, options, batch, p, stats, err);
    ec_scene written;
    memset(p, 0, sizeof *p);
    EC_TRY(ec_scene_write_out(scene, &written, err));
    ec_result result = create(cl, &written, scene, options, batch, p, stats, err);
    ec_scene_written_free(&written);
    return result;
}

ec_result ec_pipeline_create(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, uint32_t batch,
                             ec_pipeline *p, ec_render_stats *stats, ec_error *err)
{
    if (!options->without) return create_in_form(cl, scene, options, batch, p, stats, err);
    ec_scene_view view;
    memset(p, 0, sizeof *p);
    EC_TRY(ec_scene_view_without(scene, options->without, (int64_t)options->without_of - 1, &view, err));
    ec_result result = create_in_form(cl, &view.scene, options, batch, p, stats, err);
    ec_scene_view_free(&view);
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
    ec_insides_free(&p->insides);
    memset(p, 0, sizeof *p);
}
